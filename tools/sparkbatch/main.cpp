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

// Exit codes: 0 every run has a row; 1 some rows are errors, or the line is lost; 2 the command line, the config or the
// table is wrong, nothing was run; 3 it was interrupted. stdout carries one JSON line at the end, everything else goes
// to stderr.

namespace {
using namespace sparkbatch;

constexpr int kWrong = 2;
std::atomic<Wish> wish = Wish::goOn;
static_assert(std::atomic<Wish>::is_always_lock_free);

extern "C" void endBatch(int number) {
  if (wish == Wish::abandon) std::signal(number, SIG_DFL), std::raise(number);
  wish = number == SIGINT && wish == Wish::goOn ? Wish::finish : Wish::abandon;
}

/// The first SIGINT lets what runs come to its end, the second and SIGTERM abandon it; one more ends the process as the
/// system does: a config that never returns hears of nothing. Under mpirun signals end all processes at once, as MPI
/// has it; what has a row stays either way.
void watchSignals() {
  struct sigaction action = {};
  action.sa_handler = endBatch;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// Processors that this process may use, which it shares with its neighbours unless each has its own.
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
    sayLine(fmt::format("{} threads share {} processors, to which mpirun binds this process: say mpirun --bind-to none",
                        options.threads, CPU_COUNT(&mine)));
}

int lead(const Options& options, Cluster& cluster) {
  if (cluster.size() == 1) watchSignals();
  std::optional<Leader> leader;
  try {
    leader.emplace(options, cluster);
  } catch (const std::exception& e) {
    fmt::print(stderr, "sparkbatch: {}\n", e.what());
    dismiss(cluster);
    return kWrong;
  }
  const int code = leader->run(wish);
  const std::string summary = leader->summary();
  if (std::puts(summary.c_str()) >= 0 && std::fflush(stdout) == 0) return code;
  fmt::print(stderr, "sparkbatch: cannot write to stdout ({}); this line is lost there: {}\n", std::strerror(errno),
             summary);
  return std::max(code, 1);
}
}  // namespace

int main(int argc, char** argv) {
  sparkhost::installCrashReport("sparkbatch");
  std::unique_ptr<Cluster> cluster;
  try {
    cluster = Cluster::join();
    Options options;
    if (const auto code = readOptions(argc, argv, cluster->number() == 0, options)) return *code;
    chooseThreads(options, cluster->neighbours());
    if (cluster->number() == 0) return lead(options, *cluster);
    help(options, *cluster);
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "sparkbatch: {}\n", e.what());
    if (cluster) cluster->abort(kWrong);
    return kWrong;
  }
}
