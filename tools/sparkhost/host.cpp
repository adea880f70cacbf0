#include "host.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "api/snapshots.h"
#include "spark/error.h"
#include "spark/json_writer.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "status_text.h"
#include "tree_values.h"

namespace sparkhost {

using namespace spark;
namespace fs = std::filesystem;

namespace {
constexpr const char* kTape = "/sys/host/tape";

/// Writes the number of a port; null if there is no such port.
/// Writes the number of a TCP port as `name`Port, null if there is none, or the file of a Unix socket as `name`Socket.
void writePort(JsonWriter& json, const std::string& name, const Leaf& root, const char* path) {
  if (const Value file = valueAt(root, path, "file"); !file.isNil()) {
    json.member(name + "Socket", file.plain());
    return;
  }
  const Value v = valueAt(root, path, "port");
  json.key(name + "Port").raw(v.isNil() ? "null" : v.plain());
}

/// Writes the link for browsers; null if there is none.
void writeWeb(JsonWriter& json, const Leaf& root) {
  Leaf* web = root.find(kWeb);
  const std::string link = web ? callMethod(*web, "link", {}).plain() : std::string();
  json.key("web");
  if (link.empty())
    json.null();
  else
    json.value(link);
}

std::int64_t messagesDropped(const Leaf& root) {
  std::int64_t sum = 0;
  if (const Node* net = root.find<Node>(kNet))
    for (const auto& port : net->children()) sum += integerAt(*port, ".", "messagesDropped");
  return sum;
}
}  // namespace

Host::Host(const Options& options)
    : options_(options),
      bin_(fs::canonical("/proc/self/exe").parent_path()),
      share_(options.share.empty() ? installedShare() : fs::path(options.share)) {
  kernel_.log().setLevel(levelFromName(options.logLevel));
  if (options.seed) kernel_.setSeed(*options.seed);
  scanPlugins();
}

fs::path Host::installedShare() {
  return fs::canonical("/proc/self/exe").parent_path().parent_path() / "share" / "spark";
}

void Host::scanPlugins() {
  for (const std::string& folder : options_.pluginPaths) kernel_.plugins().scan(folder);
  for (const fs::path& folder : {bin_ / ".." / "plugins", bin_ / SPARK_PLUGIN_FOLDER})
    if (fs::is_directory(folder)) kernel_.plugins().scan(folder.lexically_normal());
}

void Host::defineHostTable() {
  List scenePaths(options_.scenePaths.begin(), options_.scenePaths.end());
  scripts(kernel_).setGlobal("host", List{List{"share", fs::is_directory(share_) ? share_.string() : ""},
                                          List{"scenePaths", std::move(scenePaths)}, List{"alone", options_.alone}});
}

/// Files of a recording, and folders that the user adds to those of its run, come before those of the config: the tree
/// of the simulation stays the recorded one.
void Host::mountFiles() {
  if (options_.files.empty()) return;
  constexpr const char* kFiles = "/sys/host/files";
  kernel_.plugins().use("files");
  kernel_.create("FileServer", kFiles);
  int number = 0;
  const auto mount = [&](const std::string& folder) {
    setProperty(kernel_.create("DirectoryFileSystem", fmt::format("{}/{}", kFiles, ++number)), "path", folder);
  };
  mount(options_.files);
  for (const std::string& folder : options_.moreScenePaths) mount(folder);
}

/// The command line for recordings and snapshots.
std::vector<std::string> Host::arguments() { return withoutSecrets(options_.arguments, scripts(kernel_).secrets()); }

/// Names the secrets that the recorded run had, and that this one has not.
void Host::warnOfSecrets() {
  for (const std::string& name : scripts(kernel_).secrets()) {
    const auto set = std::find_if(options_.overrides.rbegin(), options_.overrides.rend(),
                                  [&name](const auto& o) { return o.first == name; });
    const bool recorded = options_.overrides.rend() - set <= static_cast<std::ptrdiff_t>(options_.fromOverrides);
    if (set == options_.overrides.rend() || !recorded) continue;
    kernel_.log().warning("the recorded run had a {0}, which is a secret and in no recording: say --set {0}=...", name);
  }
}

void Host::build() {
  for (const std::string& note : options_.notes) kernel_.log().warning("{}", note);
  scripts(kernel_).addFolder(share_ / "lua");
  if (!options_.share.empty()) scripts(kernel_).setWorkingFolder(share_ / "lua");
  mountFiles();
  defineHostTable();
  if (options_.check) scripts(kernel_).warnOfUnsaved();
  for (const auto& [key, value] : options_.overrides) scripts(kernel_).addOverride(key, value);
  if (options_.replay) {  // what the config makes shall know it
    kernel_.plugins().use("recorder");
    kernel_.create<Leaf>("InputPlayer", kTape);
  } else if (!options_.record.empty()) {  // so that settings of the tape have an effect
    kernel_.plugins().use("recorder");
    kernel_.create<Leaf>("Recorder", kTape);
  }
  scripts(kernel_).runConfig(options_.config);
  if (!options_.from.empty()) warnOfSecrets();
  applySwitches(0);
  if (!kernel_.root().find("/plugins/recorder")) return;
  kernel_.plugins().use("recorder");
  Leaf* snapshots = kernel_.root().find(ISnapshots::kPath);
  if (!snapshots) snapshots = &kernel_.create<Leaf>("Snapshots", ISnapshots::kPath);
  const auto words = arguments();
  setProperty(*snapshots, "arguments", List(words.begin(), words.end()));
}

void Host::goOn() {
  auto* const snapshots = kernel_.root().find<ISnapshots>();
  if (!snapshots) throw Error("--from: expected the plugin recorder, found none. Add its folder by --plugin-path");
  if (options_.state) {
    for (const ForkState::Text& t : options_.state->texts) kernel_.sources().add(t.kind, t.name, t.text);
    const Snapshot state = snapshots->read(options_.state->bytes);
    snapshots->restore(state, options_.branch);
    kernel_.log().info("The run goes on from {} at {} s: cycle {}.", options_.from, options_.state->time, state.cycle);
  } else {
    snapshots->load(options_.from, options_.at, options_.branch);
  }
  for (std::size_t i = options_.fromOverrides; i < options_.overrides.size(); ++i)
    scripts(kernel_).addOverride(options_.overrides[i].first, options_.overrides[i].second);
  scripts(kernel_).applyOverrides();
  applySwitches(options_.fromSwitches);
  if (const std::string over = overAlready(); !over.empty()) kernel_.log().warning("{}", over);
}

std::string Host::overAlready() {
  const Leaf& root = kernel_.root();
  const double end = numberAt(root, kSimulation, "duration"), now = numberAt(root, kSimulation, "time");
  if (end <= 0 || end >= now + 0.5 * numberAt(root, kSimulation, "step")) return {};
  return fmt::format(
      "--duration {0}: the run goes on at {1:.2f} s already, so it has no cycle. It is the time at which a run ends, "
      "counted from its start: for {0} s more it is {2:.2f}",
      end, now, now + end);
}

/// Sets the properties of switches, from the one with that index on.
void Host::applySwitches(std::size_t first) {
  for (std::size_t i = first; i < options_.switches.size(); ++i) {
    const Options::Switch& s = options_.switches[i];
    Leaf* node = kernel_.root().find(s.path);
    if (!node)
      throw Error(fmt::format("{}: config '{}' has no {}; or omit {}.", s.flag, options_.config, s.missing,
                              s.flag.substr(0, s.flag.find(' '))));
    if (!node->classObject()->property(s.property))
      throw Error(fmt::format("{}: {} is a {}, which has no property '{}'; omit {}.", s.flag, s.path,
                              node->classObject()->name(), s.property, s.flag.substr(0, s.flag.find(' '))));
    setProperty(*node, s.property, s.value);
  }
}

void Host::record(const std::string& file) {
  const auto words = arguments();
  callMethod(kernel_.root().require<Leaf>(kTape), "record", std::vector<Value>{file, List(words.begin(), words.end())});
}

void Host::discardRecording() {
  if (Leaf* const tape = kernel_.root().find(kTape)) callMethod(*tape, "discard", {});
}

Leaf& Host::play(const std::string& file) {
  Leaf& tape = kernel_.root().require<Leaf>(kTape);
  callMethod(tape, "open", std::vector<Value>{file});
  return tape;
}

std::string Host::open() {
  if (!kernel_.root().find(kSimulation))
    throw Error(fmt::format("config '{}' has no run loop: expected a node {}. Add simulation() of house.lua.",
                            options_.config, kSimulation));
  const Node& root = kernel_.root();
  for (const char* path : {kNet, kWeb, kSpades})
    if (Leaf* server = root.find(path)) callMethod(*server, "listen", {});
  std::string line;
  JsonWriter json(line);
  json.beginObject();
  writePort(json, "agent", root, "/sys/server/net/agents");
  writePort(json, "monitor", root, "/sys/server/net/monitors");
  if (root.find(kSpades)) writePort(json, "comm", root, kSpades);
  writeWeb(json, root);
  json.endObject();
  return line;
}

std::string Host::histogram() {
  Leaf& loop = kernel_.root().require<Leaf>(kSimulation);
  return loop.classObject()->method("paceTable") ? callMethod(loop, "paceTable", {}).plain()
                                                 : fmt::format("{} has no paceTable()\n", kSimulation);
}

std::string Host::run() {
  Node& root = kernel_.root();
  const double start = numberAt(root, kSimulation, "time");
  const auto begin = std::chrono::steady_clock::now();
  callMethod(root.require<Leaf>(kSimulation), "run", {});
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (Leaf* const tape = root.find(kTape); tape && !options_.record.empty()) callMethod(*tape, "finish", {});
  const double time = numberAt(root, kSimulation, "time");
  std::string line;
  JsonWriter json(line);
  json.beginObject().member("cycles", integerAt(root, kSimulation, "cycle")).key("simSeconds").fixed(time, 2);
  json.key("realTimeFactor").fixed(wall > 0 ? (time - start) / wall : 0.0, 3);
  json.key("lostSeconds").fixed(numberAt(root, kSimulation, "lostTime"), 3);
  json.member("lateCycles", integerAt(root, kSimulation, "lateCycles"));
  writeStatus(json, StatusReporters().read(kernel_));
  json.member("agentsSeen", integerAt(root, kGameControl, "agentsSeen"));
  json.member("messagesDropped", messagesDropped(root)).member("faults", root.kernel().faults());
  json.member("stateHash", fmt::format("{:016x}", stateHash(root)));
  json.member("configurationHash", fmt::format("{:016x}", configurationHash(root))).endObject();
  return line;
}

}  // namespace sparkhost
