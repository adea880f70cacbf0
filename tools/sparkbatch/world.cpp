#include "world.h"

#include <fmt/format.h>
#include <time.h>

#include <chrono>

#include "api/phases.h"
#include "api/status.h"
#include "host.h"
#include "progress.h"
#include "spark/describe.h"
#include "spark/error.h"
#include "spark/state.h"
#include "tree_values.h"

namespace sparkbatch {

using namespace spark;
using namespace sparkhost;

namespace {
constexpr const char* kResult = "/sys/variables/Result";

/// The world's side of a Watch. Has no state.
class Pulse : public Node {
  SPARK_CLASS(Pulse, Node)
 public:
  static void describe(Description<Pulse>& d) {
    d.doc("Tells the batch how far this world is.");
    d.on<&Pulse::beat>(phase::kPublish);
  }
  Watch* watch = nullptr;

 private:
  void beat(const Event& event) {
    if (!watch) return;
    watch->setTime(event.time);
    if (watch->abandoned()) kernel().requestStop();
  }
};

/// CPU seconds of this thread and wall seconds since it was made.
class Stopwatch {
 public:
  double cpu() const { return cpuNow() - cpu_; }
  double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(); }

 private:
  static double cpuNow() {
    timespec t = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double cpu_ = cpuNow();
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
};

std::string replaced(std::string text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// What sparkhost would be told for the same world. A setting of the user's comes last: it wins.
sparkhost::Options hostOptions(const Options& options, const Run& run) {
  sparkhost::Options out;
  out.config = options.config;
  out.seed = run.seed;
  out.pluginPaths = options.pluginPaths;
  out.scenePaths = options.scenePaths;
  out.logLevel = options.logLevel;
  out.alone = true;
  out.overrides = {{"/sys/server/simulation.rate", "max"}, {"/sys/server/simulation.threads", 1}};
  if (options.duration > 0) out.overrides.emplace_back("/sys/server/simulation.duration", options.duration);
  const auto set = [&](const std::string& key, const std::string& text) {
    out.overrides.emplace_back(key, Value::typed(replaced(replaced(text, "{run}", std::to_string(run.number)), "{seed}",
                                                          std::to_string(run.seed))));
  };
  for (const auto& [key, text] : options.settings) set(key, text);
  for (const auto& [key, text] : run.point) set(key, text);
  return out;
}

/// The house, its log on stderr with the run's number. `fault` becomes what the log says of the first fault, when its
/// level lets it.
std::unique_ptr<Host> makeHost(const sparkhost::Options& options, const Run& run, std::string* fault = nullptr) {
  auto host = std::make_unique<Host>(options);
  Kernel& kernel = host->kernel();
  kernel.log().setSink([&kernel, fault, number = run.number](Level level, std::string_view text) {
    if (fault && fault->empty() && level >= Level::warning && kernel.faults() > 0) *fault = text;
    sayLine(fmt::format("run {}: {}", number, text));
  });
  return host;
}

/// Why the numbers of a run whose plugins or scripts failed are none to rely on.
std::string faultsOf(const Kernel& kernel, const std::string& first) {
  const std::int64_t n = kernel.faults();
  return fmt::format("{} fault{} of plugins or scripts; {}", n, n == 1 ? "" : "s",
                     first.empty() ? "--log-level warning tells the first of each place" : "the first: " + first);
}

Json toJson(const Value& v) {
  switch (v.type()) {
    case Value::Type::nil:
      return nullptr;
    case Value::Type::boolean:
      return v.toBool();
    case Value::Type::integer:
      return v.toInteger();
    case Value::Type::number:
      return v.toNumber();
    case Value::Type::string:
      return v.toString();
    case Value::Type::list:
      break;
  }
  Json list = Json::array();
  for (const Value& e : v.toList()) list.push_back(toJson(e));
  return list;
}

/// Half a step of tolerance, as the run loop has it.
std::string reason(const Leaf& root) {
  const double duration = numberAt(root, kSimulation, "duration");
  const bool over =
      duration > 0 && numberAt(root, kSimulation, "time") > duration - 0.5 * numberAt(root, kSimulation, "step");
  return over ? "duration" : "stopped";
}

/// Agents of a batch live in the house.
void closeNetwork(Node& root) {
  Leaf* net = root.find(kNet);
  if (net && net->classObject()->property("open")) setProperty(*net, "open", false);
}

/// A further column. Throws Error when there is one of that name.
void put(Row& row, const std::string& column, const Value& value) {
  if (row.contains(column))
    throw Error(fmt::format("cannot report {0}: the table has another column {0}. Name it otherwise.", column));
  row[column] = toJson(value);
}

void addReports(const Leaf& root, const std::vector<Report>& reports, Row& row) {
  for (const Report& r : reports) put(row, r.column, getProperty(root.require<Leaf>(r.path), r.property));
}

/// What the config left in the variables Result.*.
void addResults(Node& root, Row& row) {
  Leaf* group = root.find(kResult);
  if (!group) return;
  const Value names = getProperty(*group, "names");
  for (const Value& name : names.toList()) put(row, name.plain(), callMethod(*group, "get", std::span(&name, 1)));
}

void addOutcome(const Leaf& root, Row& row) {
  row["end"] = reason(root);
  row["cycles"] = integerAt(root, kSimulation, "cycle");
  row["simSeconds"] = numberAt(root, kSimulation, "time");
  row["stateHash"] = fmt::format("{:016x}", stateHash(root));
}

/// What the game reports: a column for each entry, or for each element of a list.
void addStatus(Kernel& kernel, Row& row) {
  for (const StatusEntry& entry : StatusReporters().read(kernel)) {
    if (!entry.value.isList()) {
      put(row, entry.name, entry.value);
      continue;
    }
    const List& elements = entry.value.toList();
    for (std::size_t i = 0; i < elements.size(); ++i)
      put(row, entry.name + (i < entry.parts.size() ? entry.parts[i] : std::to_string(i + 1)), elements[i]);
  }
}
}  // namespace

void check(const Options& options, const Run& run) {
  const sparkhost::Options asked = hostOptions(options, run);
  const auto host = makeHost(asked, run);
  host->build();
}

Row simulate(const Options& options, const Run& run, Watch& watch) {
  Row row{{"run", run.number}, {"seed", run.seed}};
  for (const auto& [key, text] : run.point) row[key] = toJson(Value::fromText(text));
  const Stopwatch clock;
  std::string error, fault;
  try {
    const sparkhost::Options asked = hostOptions(options, run);
    const auto host = makeHost(asked, run, &fault);
    host->build();
    closeNetwork(host->kernel().root());
    host->kernel().registerClass<Pulse>();
    host->kernel().create<Pulse>("Pulse", "/sys/host/pulse").watch = &watch;
    Node& root = host->kernel().root();
    callMethod(root.require<Leaf>(kSimulation), "run", {});
    addOutcome(root, row);
    addStatus(host->kernel(), row);
    addReports(root, options.reports, row);
    addResults(root, row);
    if (host->kernel().faults() > 0) error = faultsOf(host->kernel(), fault);
  } catch (const std::exception& e) {
    error = e.what();
  } catch (...) {
    error = "something was thrown that is no std::exception";
  }
  if (!error.empty()) row["end"] = "error";
  row["cpuSeconds"] = clock.cpu();
  row["wallSeconds"] = clock.wall();
  if (!error.empty()) row["error"] = error;
  return row;
}

}  // namespace sparkbatch
