#include "world.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "api/phases.h"
#include "api/status.h"
#include "host.h"
#include "json_value.h"
#include "progress.h"
#include "recorded_run.h"
#include "spark/describe.h"
#include "spark/error.h"
#include "spark/output_file.h"
#include "spark/state.h"
#include "tree_values.h"

namespace sparkbatch {

using namespace spark;
using namespace sparkhost;

namespace {
constexpr const char* kResult = "/sys/variables/Result";

/// Connects a world with its RunControl. It has no state.
class Pulse : public Node {
  SPARK_CLASS(Pulse, Node)
 public:
  static void describe(Description<Pulse>& d) {
    d.doc("Reports the simulated time of this world to the batch.");
    d.on<&Pulse::beat>(phase::kPublish);
  }
  RunControl* control = nullptr;

 private:
  void beat(const Event& event) {
    if (!control) return;
    control->setTime(event.time);
    if (control->abandoned()) kernel().requestStop();
  }
};

/// CPU time of this thread and wall time since construction [s].
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

/// The options of sparkhost for the same world. Settings of the user come last, so they win.
sparkhost::Options hostOptions(const Options& options, const Run& run) {
  sparkhost::Options out;
  out.config = options.config;
  out.seed = run.seed;
  out.pluginPaths = options.pluginPaths;
  out.scenePaths = options.scenePaths;
  out.logLevel = options.logLevel;
  out.alone = !options.origin;  // a run that goes on has the tree of the first one
  out.overrides = {{"/sys/server/simulation.rate", "max"}, {"/sys/server/simulation.threads", 1}};
  if (options.duration > 0) out.overrides.emplace_back("/sys/server/simulation.duration", options.duration);
  const auto set = [&](const std::string& key, const std::string& text) {
    out.overrides.emplace_back(key, Value::typed(replaced(replaced(text, "{run}", std::to_string(run.number)), "{seed}",
                                                          std::to_string(run.seed))));
  };
  for (const auto& [key, text] : options.settings) set(key, text);
  for (const auto& [key, text] : run.point) set(key, text);
  if (!options.origin) return out;
  out.from = options.from;
  out.at = options.at;
  out.state = options.state;
  return options.origin->options(out);
}

/// A host whose log lines go to stderr with the run's number. `fault` is set to the log line of the first fault, if the
/// log level permits it.
std::unique_ptr<Host> makeHost(const sparkhost::Options& options, const Run& run, std::string* fault = nullptr) {
  auto host = std::make_unique<Host>(options);
  Kernel& kernel = host->kernel();
  kernel.log().setSink([&kernel, fault, number = run.number](Level level, std::string_view text) {
    if (fault && fault->empty() && level >= Level::warning && kernel.faults() > 0) *fault = text;
    printLine(fmt::format("run {}: {}", number, text));
  });
  return host;
}

/// The error text of a run in which plugins or scripts failed.
std::string faultsOf(const Kernel& kernel, const std::string& first) {
  const std::int64_t n = kernel.faults();
  return fmt::format("{} fault{} of plugins or scripts; {}", n, n == 1 ? "" : "s",
                     first.empty() ? "--log-level warning tells the first of each place" : "the first: " + first);
}

/// How the run ended. With a tolerance of half a step, as in the run loop.
std::string endOf(const Leaf& root) {
  const double duration = numberAt(root, kSimulation, "duration");
  const bool atEnd =
      duration > 0 && numberAt(root, kSimulation, "time") > duration - 0.5 * numberAt(root, kSimulation, "step");
  return atEnd ? "duration" : "stopped";
}

/// Agents of a batch are behaviors inside the host; no port is needed.
void closeNetwork(Node& root) {
  Leaf* net = root.find(kNet);
  if (net && net->classObject()->property("open")) setProperty(*net, "open", false);
}

/// Adds a column. Throws Error if there is one of that name.
void put(Row& row, const std::string& column, const Value& value) {
  if (row.contains(column))
    throw Error(fmt::format("cannot report {0}: the table has another column {0}. Name it otherwise.", column));
  row[column] = toJson(value);
}

void addReports(const Leaf& root, const std::vector<Report>& reports, Row& row) {
  for (const Report& r : reports) put(row, r.column, getProperty(root.require<Leaf>(r.path), r.property));
}

/// Adds the variables Result.* of the config.
void addResults(Node& root, Row& row) {
  Leaf* group = root.find(kResult);
  if (!group) return;
  const Value names = getProperty(*group, "names");
  for (const Value& name : names.toList()) put(row, name.plain(), callMethod(*group, "get", std::span(&name, 1)));
}

void addOutcome(const Leaf& root, Row& row) {
  row["end"] = endOf(root);
  row["cycles"] = integerAt(root, kSimulation, "cycle");
  // Time is a sum of steps: its last digits are those of rounding.
  row["simSeconds"] = std::round(numberAt(root, kSimulation, "time") * 1e9) / 1e9;
  row["stateHash"] = fmt::format("{:016x}", stateHash(root));
}

/// Adds the status of the game: a column for each entry, or for each element of a list.
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

void build(Host& host, const Options& options) {
  host.build();
  if (!options.origin) return;
  host.goOn();
  if (const std::string over = host.overAlready(); !over.empty()) throw Error(over);
  // No agent comes from outside.
  if (Leaf* const control = host.kernel().root().find(kGameControl)) setProperty(*control, "expect", 0);
}
}  // namespace

namespace {
/// Builds the world of a run; the files that it would write.
std::vector<std::string> filesOf(const Options& options, const Run& run) {
  const outputs::Trial trial;
  const sparkhost::Options hosted = hostOptions(options, run);
  const auto host = makeHost(hosted, run);
  build(*host, options);
  return trial.files();
}

/// Runs that differ from the first in one thing: the value of one setting, or the seed.
std::vector<std::int64_t> neighboursOfFirst(const Options& options, const Sweep& sweep) {
  std::vector<std::int64_t> out;
  std::int64_t stride = 1;  // the last parameter changes fastest
  for (auto p = options.sweep.rbegin(); p != options.sweep.rend(); ++p) {
    if (p->values.size() > 1) out.push_back(1 + stride);
    stride *= static_cast<std::int64_t>(p->values.size());
  }
  if (options.seeds > 1) out.push_back(1 + sweep.points());
  return out;
}
}  // namespace

void check(const Options& options, const Sweep& sweep) {
  const std::vector<std::string> files = filesOf(options, sweep.run(1));
  if (files.empty()) return;
  for (const std::int64_t other : neighboursOfFirst(options, sweep))
    for (const std::string& file : filesOf(options, sweep.run(other)))
      if (std::binary_search(files.begin(), files.end(), file))
        throw Error(
            fmt::format("runs 1 and {} would both write {}: expected a name of its own for each run. Put {{run}} "
                        "into it, such as --set monitorLog=match-{{run}}.log",
                        other, file));
}

Row simulate(const Options& options, const Run& run, RunControl& control) {
  Row row{{"run", run.number}, {"seed", run.seed}};
  for (const auto& [key, text] : run.point) row[key] = toJson(Value::fromText(text));
  const Stopwatch clock;
  std::string error, fault;
  try {
    const sparkhost::Options hosted = hostOptions(options, run);
    const auto host = makeHost(hosted, run, &fault);
    build(*host, options);
    closeNetwork(host->kernel().root());
    host->kernel().registerClass<Pulse>();
    host->kernel().create<Pulse>("Pulse", "/sys/host/pulse").control = &control;
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
