#include <benchmark/benchmark.h>

#include <array>

#include "micro.h"
#include "spark/kernel.h"

namespace spark::bench {

namespace {
constexpr std::size_t kJobs = 22;  // as many as a match has agents

/// Arithmetic that takes about as long as a percept.
void work(double& out) {
  for (int i = 0; i < 2000; ++i) out = out * 0.999 + 1;
}

void runJobs(benchmark::State& state) {
  Jobs jobs;
  jobs.setThreads(static_cast<int>(state.range(0)));
  std::array<double, kJobs> out{};
  const bool idle = state.range(1) == 0;
  for (auto _ : state)
    jobs.run(kJobs, [&](std::size_t i) {
      if (!idle) work(out[i]);
    });
  benchmark::DoNotOptimize(out);
}
}  // namespace

void registerJobs() {
  benchmark::RegisterBenchmark("jobs/22", runJobs)
      ->ArgNames({"threads", "work"})
      ->ArgsProduct({{1, 2, 4}, {0, 1}})
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace spark::bench
