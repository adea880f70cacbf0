#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <thread>

#include "batch.h"
#include "crash_report.h"
#include "output.h"
#include "recorded_run.h"
#include "spark/output_file.h"
#include "state_at.h"

// Exit codes: 0: every run has a row; 1: some rows are errors, or stdout could not be written; 2: an error in the
// command line, the config or the table, nothing was run; 3: interrupted. stdout gets one JSON line at the end,
// everything else goes to stderr.

namespace {
using namespace sparkbatch;

constexpr int kUsageError = 2;
std::atomic<StopMode> stopMode = StopMode::none;
static_assert(std::atomic<StopMode>::is_always_lock_free);  // for the signal handler

extern "C" void endBatch(int number) {
  if (stopMode == StopMode::abandon) std::signal(number, SIG_DFL), std::raise(number);
  stopMode = number == SIGINT && stopMode == StopMode::none ? StopMode::finish : StopMode::abandon;
}

/// The first SIGINT lets current runs finish; the second one, or SIGTERM, abandons them; one more kills the process,
/// which helps if a config never returns. Under mpirun a signal ends all processes at once. Written rows stay in any
/// case.
void watchSignals() {
  struct sigaction action = {};
  action.sa_handler = endBatch;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// Number of processors for this process. Processes on one machine share them, unless each is bound to its own.
int processors(int neighbours) {
  cpu_set_t mine;
  const int allowed = sched_getaffinity(0, sizeof mine, &mine) == 0 ? CPU_COUNT(&mine) : 1;
  const int share = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / neighbours);
  return std::max(1, std::min(allowed, share));
}

void chooseThreads(Options& options, int neighbours) {
  cpu_set_t mine;
  if (options.threads == 0)
    options.threads = processors(neighbours);
  else if (neighbours > 1 && sched_getaffinity(0, sizeof mine, &mine) == 0 && options.threads > CPU_COUNT(&mine))
    printLine(
        fmt::format("{} threads share {} processors, to which mpirun binds this process: say mpirun --bind-to none",
                    options.threads, CPU_COUNT(&mine)));
}

/// Opens the recording, and simulates the state from which runs branch.
void branch(Options& options, std::optional<sparkhost::RecordedRun>& origin) {
  options.origin = &origin.emplace(options.from);
  spark::outputs::permit(options.results);
  options.begin = static_cast<double>(origin->recording().end()) * 1e-9;
  if (!std::isfinite(options.at)) return;
  sparkhost::Options own;
  own.at = options.at, own.logLevel = options.logLevel, own.alone = false;
  own.pluginPaths = options.pluginPaths, own.scenePaths = options.scenePaths;
  options.state = sparkhost::stateAt(*origin, own);
  if (options.state) options.begin = options.state->time;
}

int lead(const Options& options, Cluster& cluster) {
  if (cluster.size() == 1) watchSignals();
  std::optional<Leader> leader;
  try {
    leader.emplace(options, cluster);
  } catch (const std::exception& e) {
    sparkhost::printError(fmt::format("sparkbatch: {}\n", e.what()));
    dismissHelpers(cluster);
    return kUsageError;
  }
  const int code = leader->run(stopMode);
  const std::string summary = leader->summary();
  if (sparkhost::printOut(summary + '\n')) return code;
  sparkhost::printError(fmt::format("sparkbatch: cannot write to stdout ({}); this line is lost there: {}\n",
                                    std::strerror(errno), summary));
  return std::max(code, 1);
}
}  // namespace

int main(int argc, char** argv) {
  sparkhost::installCrashReport("sparkbatch");
  sparkhost::survivePoorOutputs();
  std::unique_ptr<Cluster> cluster;
  try {
    cluster = Cluster::join();
    Options options;
    if (const auto code = readOptions(argc, argv, cluster->number() == 0, options)) return *code;
    sparkhost::reserveStdout();
    chooseThreads(options, cluster->neighbours());
    std::optional<sparkhost::RecordedRun> origin;
    // Files of runs without a row were begun by this batch.
    spark::outputs::setReplace(options.force || options.resume);
    if (!options.from.empty()) branch(options, origin);
    if (cluster->number() == 0) return lead(options, *cluster);
    runHelper(options, *cluster);
    return 0;
  } catch (const std::exception& e) {
    sparkhost::printError(fmt::format("sparkbatch: {}\n", e.what()));
    if (cluster) cluster->abort(kUsageError);
    return kUsageError;
  }
}
