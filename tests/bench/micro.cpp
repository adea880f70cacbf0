#include "micro.h"

#include <benchmark/benchmark.h>

#include <string>

namespace spark::bench {

void runMicro(bool json) {
  registerYardsticks();
  registerJobs();
  registerBytes();
  registerRays();
  registerSnapshots();
  std::string program = "sparkbench", format = json ? "--benchmark_format=json" : "--benchmark_format=console";
  char* arguments[] = {program.data(), format.data(), nullptr};
  int count = 2;
  benchmark::Initialize(&count, arguments);
  benchmark::RunSpecifiedBenchmarks();
}

}  // namespace spark::bench
