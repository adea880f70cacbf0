#include "batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "host.h"
#include "spark/error.h"
#include "spark/random.h"

// The protocol between the processes:
//
//   leader (process 0)                                     helper (any other process that mpirun started)
//     owns the table, assigns runs, has worker threads       has worker threads
//                                 ◄── ready ──               a thread is idle
//     number of a run, or none    ── run ────►               starts it
//     adds the row to the table   ◄── row ────               a run has ended
//     counts the helper as done   ◄── done ───               no run is left and none is running
//     all helpers are done        ── exit ───►               exits
//
// A blocking receive of MPI spins, and the leader must wait for threads and helpers at the same time. So both poll for
// messages every few milliseconds, which is cheap compared with runs of seconds. If a process dies, mpirun ends all;
// written rows stay.

namespace sparkbatch {

using spark::Error;
namespace fs = std::filesystem;

namespace {
// Maximum time of a wait for worker threads, after which signals and messages of helpers are handled.
constexpr auto kWaitAlone = std::chrono::milliseconds(50);
constexpr auto kWaitWithHelpers = std::chrono::milliseconds(2);
constexpr int kFailed = 1, kInterrupted = 3;  // exit codes
constexpr int kMaxFailuresShown = 5;          // on stderr

/// The text of the config, looked up like sparkhost does; "" if it is not found.
std::string configText(const std::string& config) {
  const fs::path share = fs::canonical("/proc/self/exe").parent_path().parent_path() / "share" / "spark" / "lua";
  for (const fs::path& file : {fs::path(config), share / config}) {
    if (!fs::is_regular_file(file)) continue;
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  return {};
}

/// The settings that must be the same for all rows of a table. The number of runs may change.
Json batchOf(const Options& o) {
  Json batch{{"config", o.from.empty() ? o.config : fmt::format("{} at {}", o.from, o.at)},
             {"config's text (hash)",
              fmt::format("{:016x}", spark::hashBytes(configText(o.from.empty() ? o.config : o.from)))},
             {"first seed", o.seed},
             {"duration", o.duration}};
  Json settings = Json::object(), sweep = Json::array(), reports = Json::array();
  for (const auto& [key, text] : o.settings) settings[key] = text;
  for (const Parameter& p : o.sweep) sweep.push_back({{"key", p.key}, {"values", p.values}});
  for (const Report& r : o.reports) reports.push_back(fmt::format("{}={}.{}", r.column, r.path, r.property));
  batch["settings"] = settings;
  batch["sweep"] = sweep;
  batch["reports"] = reports;
  batch["scene paths"] = o.scenePaths;
  batch["plugin paths"] = o.pluginPaths;
  return batch;
}

Table::Open openMode(const Options& o) {
  return o.retry    ? Table::Open::retry
         : o.resume ? Table::Open::resume
         : o.force  ? Table::Open::replace
                    : Table::Open::fresh;
}

/// For a new table, builds the first worlds, so that a mistake in the command line is an error and not a table of
/// errors.
const Options& checked(const Options& options, const Sweep& sweep) {
  if (options.force || !fs::exists(options.results)) check(options, sweep);
  return options;
}

/// Number of the first `runs` runs that have a row.
std::int64_t countExisting(const Table& table, std::int64_t runs) {
  std::int64_t n = 0;
  for (std::int64_t run = 1; run <= runs; ++run) n += table.has(run);
  return n;
}

/// Keeps the plugins loaded. Without it, the end of the only running world would unload them, and the next world would
/// load them again.
struct PluginKeeper {
  explicit PluginKeeper(const Options& o) {
    hostOptions.pluginPaths = o.pluginPaths;
    hostOptions.logLevel = o.logLevel;
    host.emplace(hostOptions);
  }
  sparkhost::Options hostOptions;
  std::optional<sparkhost::Host> host;
};

/// The function that a worker thread calls for each run.
Workers::Work work(const Options& options) {
  return [&options, plugins = std::make_shared<PluginKeeper>(options)](const Run& run, RunControl& control) {
    return simulate(options, run, control);
  };
}
}  // namespace

Leader::Leader(const Options& options, Cluster& cluster)
    : options_(options),
      cluster_(cluster),
      sweep_(options.sweep, options.seed, options.seeds),
      table_(checked(options, sweep_).results, batchOf(options), openMode(options)),
      existing_(countExisting(table_, sweep_.runs())),
      progress_(sweep_.runs(), existing_, std::max(options.duration - options.begin, 0.0)),
      workers_(options.threads, work(options)),
      usage_(options.threads),
      helpers_(cluster.size() - 1) {}

/// The number of the next run without a row; 0 if there is none or the batch is being stopped.
std::int64_t Leader::next(StopMode stop) {
  if (stop != StopMode::none) return 0;
  while (number_ < sweep_.runs())
    if (!table_.has(++number_)) return number_;
  return 0;
}

/// Gives a run to each idle thread of this process.
void Leader::startRuns(StopMode stop) {
  while (workers_.idle() > 0) {
    const std::int64_t number = next(stop);
    if (number == 0) return;
    workers_.start(sweep_.run(number));
  }
}

/// Handles the messages of helpers that have arrived.
void Leader::handleMessages(StopMode stop) {
  while (const auto message = cluster_.receive()) {
    if (message->kind == MessageKind::ready) {
      const std::int64_t number = next(stop);
      cluster_.send(message->from, MessageKind::run, number == 0 ? "" : std::to_string(number));
    } else if (message->kind == MessageKind::row) {
      add(Row::parse(message->text));
    } else {
      usage_.add(Json::parse(message->text));
      --helpers_;
    }
  }
}

void Leader::add(Row row) {
  const bool failed = row.value("end", "") == "error";
  usage_.addCpu(row.value("cpuSeconds", 0.0));
  progress_.add(std::max(row.value("simSeconds", 0.0) - options_.begin, 0.0), failed);
  if (failed && progress_.failed() <= kMaxFailuresShown)
    printLine(
        fmt::format("run {} failed: {}{}", row["run"].get<std::int64_t>(), row.value("error", ""),
                    progress_.failed() == kMaxFailuresShown ? "\n(further errors are told in the table only)" : ""));
  table_.add(std::move(row));
}

int Leader::run(const std::atomic<StopMode>& stop) {
  startRuns(stop);
  while (workers_.running() > 0 || helpers_ > 0) {
    if (stop == StopMode::abandon) workers_.abandon();
    for (auto& result : workers_.collect(cluster_.size() > 1 ? kWaitWithHelpers : kWaitAlone))
      if (result) add(std::move(*result));
    startRuns(stop);
    handleMessages(stop);
    progress_.show(std::max(workers_.time() - options_.begin * workers_.running(), 0.0));
  }
  for (int other = 1; other < cluster_.size(); ++other) cluster_.send(other, MessageKind::exit, "");
  usage_.measure();
  progress_.end();
  if (existing_ + progress_.done() < sweep_.runs()) return kInterrupted;
  table_.sort();
  return progress_.failed() > 0 ? kFailed : 0;
}

std::string Leader::summary() const {
  const double cpu = usage_.cpuSeconds(), wall = progress_.elapsed();
  const auto rounded = [](double v) { return std::stod(fmt::format("{:.4g}", v)); };
  return Json{{"runs", sweep_.runs()},
              {"there", existing_},
              {"done", progress_.done()},
              {"failed", progress_.failed()},
              {"processes", cluster_.size()},
              {"threads", usage_.threads()},
              {"simSeconds", rounded(progress_.simulated())},
              {"wallSeconds", rounded(wall)},
              {"cpuSeconds", rounded(cpu)},
              {"realTimeFactor", rounded(wall > 0 ? progress_.simulated() / wall : 0)},
              {"simSecondsPerCpuSecond", rounded(cpu > 0 ? progress_.simulated() / cpu : 0)},
              {"peakMegabytes", rounded(usage_.peakMegabytes())},
              {"megabytesPerWorld", rounded(usage_.megabytesPerWorld())}}
      .dump();
}

void dismissHelpers(Cluster& cluster) {
  for (int helpers = cluster.size() - 1; helpers > 0;) {
    const auto message = cluster.receive();
    if (!message)
      std::this_thread::sleep_for(kWaitWithHelpers);
    else if (message->kind == MessageKind::ready)
      cluster.send(message->from, MessageKind::run, "");
    else if (message->kind == MessageKind::done)
      --helpers;
  }
  for (int other = 1; other < cluster.size(); ++other) cluster.send(other, MessageKind::exit, "");
}

void runHelper(const Options& options, Cluster& cluster) {
  const Sweep sweep(options.sweep, options.seed, options.seeds);
  Workers workers(options.threads, work(options));
  Usage usage(options.threads);
  int requested = 0;      // runs
  bool finished = false;  // there are no more runs
  while (!finished || requested > 0 || workers.running() > 0) {
    for (; !finished && workers.idle() > requested; ++requested) cluster.send(0, MessageKind::ready, "");
    while (const auto message = cluster.receive()) {
      --requested;
      if (message->text.empty())
        finished = true;
      else
        workers.start(sweep.run(std::stoll(message->text)));
    }
    for (const auto& row : workers.collect(kWaitWithHelpers))
      if (row) cluster.send(0, MessageKind::row, row->dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  usage.measure();
  cluster.send(0, MessageKind::done, usage.json().dump());
  while (!cluster.receive()) std::this_thread::sleep_for(kWaitWithHelpers);
}

}  // namespace sparkbatch
