#include "batch.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host.h"
#include "spark/error.h"
#include "spark/random.h"

// Who does what:
//
//   leader (process 0)                                     helper (any other process that mpirun started)
//     table, progress, which run is next                     its own threads
//     its own threads                                        a thread is idle ── ready ──►
//       ◄───────────────────────────────────────────────── a number, or none ── run ───►
//     a row goes into the table   ◄── row ──                 a world has ended
//     all helpers are done        ◄── bye ──                 no runs, no worlds
//     ── home ──►                                            leaves
//
// MPI's own waiting spins, and the leader waits for threads and helpers at once: both look for messages every few
// milliseconds, which beside runs of seconds is nothing. When a process dies mpirun ends all; what has a row stays.

namespace sparkbatch {

using spark::Error;
namespace fs = std::filesystem;

namespace {
constexpr auto kAlone = std::chrono::milliseconds(50);    // bound on the delay of a signal
constexpr auto kTogether = std::chrono::milliseconds(2);  // and of a helper's message
constexpr int kFailed = 1, kInterrupted = 3;
constexpr int kFailuresShown = 5;

/// The config's text, where it is found as the host finds it; empty when it is not there.
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

/// What must be the same for all rows of a table. Not the number of seeds: more may be added.
Json batchOf(const Options& o) {
  Json batch{{"config", o.config},
             {"config's text (hash)", fmt::format("{:016x}", spark::hashBytes(configText(o.config)))},
             {"first seed", o.seed},
             {"duration", o.duration}};
  Json settings = Json::object(), sweep = Json::array(), reports = Json::array();
  for (const auto& [key, text] : o.settings) settings[key] = text;
  for (const Parameter& p : o.sweep) sweep.push_back({{"key", p.key}, {"values", p.values}});
  for (const Report& r : o.reports) reports.push_back(r.column + "=" + r.path + "." + r.property);
  batch["settings"] = settings;
  batch["sweep"] = sweep;
  batch["reports"] = reports;
  batch["scene paths"] = o.scenePaths;
  batch["plugin paths"] = o.pluginPaths;
  return batch;
}

Table::Open opening(const Options& o) {
  return o.retry ? Table::Open::retry : o.resume ? Table::Open::resume : Table::Open::fresh;
}

/// A table that is begun is begun with a world that can be built: a slip in the command line is no row.
const Options& checked(const Options& options, const Sweep& sweep) {
  if (!fs::exists(options.results)) check(options, sweep.run(1));
  return options;
}

std::int64_t countThere(const Table& table, std::int64_t runs) {
  std::int64_t n = 0;
  for (std::int64_t run = 1; run <= runs; ++run) n += table.has(run);
  return n;
}

/// Keeps the plugins mapped: otherwise every world that ends alone would take them out of the process, and the next
/// would load them anew.
struct Keeper {
  explicit Keeper(const Options& o) {
    asked.pluginPaths = o.pluginPaths;
    asked.logLevel = o.logLevel;
    host.emplace(asked);
  }
  sparkhost::Options asked;
  std::optional<sparkhost::Host> host;
};

Workers::Work work(const Options& options) {
  return [&options, plugins = std::make_shared<Keeper>(options)](const Run& run, Watch& watch) {
    return simulate(options, run, watch);
  };
}
}  // namespace

Leader::Leader(const Options& options, Cluster& cluster)
    : options_(options),
      cluster_(cluster),
      sweep_(options.sweep, options.seed, options.seeds),
      table_(checked(options, sweep_).results, batchOf(options), opening(options)),
      there_(countThere(table_, sweep_.runs())),
      progress_(sweep_.runs(), there_, options.duration),
      workers_(options.threads, work(options)),
      usage_(options.threads),
      helpers_(cluster.size() - 1) {}

/// The number of the next run without a row, 0 when nothing more is to be begun.
std::int64_t Leader::next(Wish wish) {
  if (wish != Wish::goOn) return 0;
  while (number_ < sweep_.runs())
    if (!table_.has(++number_)) return number_;
  return 0;
}

void Leader::begin(Wish wish) {
  while (workers_.idle() > 0) {
    const std::int64_t number = next(wish);
    if (number == 0) return;
    workers_.begin(sweep_.run(number));
  }
}

void Leader::answer(Wish wish) {
  while (const auto message = cluster_.receive()) {
    if (message->word == Word::ready) {
      const std::int64_t number = next(wish);
      cluster_.send(message->from, Word::run, number == 0 ? "" : std::to_string(number));
    } else if (message->word == Word::row) {
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
  progress_.add(row.value("simSeconds", 0.0), failed);
  if (failed && progress_.failed() <= kFailuresShown)
    sayLine(fmt::format("run {} failed: {}{}", row["run"].get<std::int64_t>(), row.value("error", ""),
                        progress_.failed() == kFailuresShown ? "\n(further errors are told in the table only)" : ""));
  table_.add(std::move(row));
}

int Leader::run(const std::atomic<Wish>& wish) {
  begin(wish);
  while (workers_.running() > 0 || helpers_ > 0) {
    if (wish == Wish::abandon) workers_.abandon();
    for (auto& result : workers_.take(cluster_.size() > 1 ? kTogether : kAlone))
      if (result) add(std::move(*result));
    begin(wish);
    answer(wish);
    progress_.show(workers_.time());
  }
  for (int other = 1; other < cluster_.size(); ++other) cluster_.send(other, Word::home, "");
  usage_.measure();
  progress_.end();
  if (there_ + progress_.done() < sweep_.runs()) return kInterrupted;
  table_.sort();
  return progress_.failed() > 0 ? kFailed : 0;
}

std::string Leader::summary() const {
  const double cpu = usage_.cpuSeconds(), wall = progress_.elapsed();
  const auto rounded = [](double v) { return std::stod(fmt::format("{:.4g}", v)); };
  return Json{{"runs", sweep_.runs()},
              {"there", there_},
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

void dismiss(Cluster& cluster) {
  for (int helpers = cluster.size() - 1; helpers > 0;) {
    const auto message = cluster.receive();
    if (!message)
      std::this_thread::sleep_for(kTogether);
    else if (message->word == Word::ready)
      cluster.send(message->from, Word::run, "");
    else if (message->word == Word::bye)
      --helpers;
  }
  for (int other = 1; other < cluster.size(); ++other) cluster.send(other, Word::home, "");
}

void help(const Options& options, Cluster& cluster) {
  const Sweep sweep(options.sweep, options.seed, options.seeds);
  Workers workers(options.threads, work(options));
  Usage usage(options.threads);
  int asked = 0;
  bool over = false;
  while (!over || asked > 0 || workers.running() > 0) {
    for (; !over && workers.idle() > asked; ++asked) cluster.send(0, Word::ready, "");
    while (const auto message = cluster.receive()) {
      --asked;
      if (message->text.empty())
        over = true;
      else
        workers.begin(sweep.run(std::stoll(message->text)));
    }
    for (const auto& row : workers.take(kTogether))
      if (row) cluster.send(0, Word::row, row->dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  usage.measure();
  cluster.send(0, Word::bye, usage.json().dump());
  while (!cluster.receive()) std::this_thread::sleep_for(kTogether);
}

}  // namespace sparkbatch
