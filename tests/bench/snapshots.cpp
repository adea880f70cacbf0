#include "api/snapshots.h"

#include <benchmark/benchmark.h>

#include <string>
#include <utility>

#include "house.h"
#include "micro.h"

// The cost of going back to an instant, as a program that learns does after each episode: saving the state, and
// restoring it, for one humanoid and for two teams.

namespace spark::bench {

namespace {

struct Episode {
  LocalEntrance entrance;
  Instance instance;
  ISnapshots& snapshots;
  Snapshot start;

  explicit Episode(const std::string& world)
      : instance({worldOf(world)}, entrance), snapshots(made(instance.kernel())) {
    for (int i = 0; i < 3; ++i) {
      snapshots.take(start, false);
      snapshots.restore(start);
    }
  }
  static ISnapshots& made(Kernel& kernel) {
    kernel.plugins().use("recorder");
    return kernel.create<ISnapshots>("Snapshots", ISnapshots::kPath);
  }
};

template <class F>
void run(benchmark::State& state, const char* world, F&& f) {
  Episode episode(world);
  for (auto _ : state) f(episode);
  state.counters["bytes"] = static_cast<double>(episode.start.state.size());
}

}  // namespace

void registerSnapshots() {
  for (const auto& [name, world] : {std::pair{"1", "rest1"}, {"22", "rest22"}}) {
    benchmark::RegisterBenchmark((std::string("snapshot/take/") + name).c_str(), [world =
                                                                                      world](benchmark::State& state) {
      run(state, world, [](Episode& e) { e.snapshots.take(e.start, false); });
    })->Unit(benchmark::kMicrosecond);
    benchmark::RegisterBenchmark((std::string("snapshot/restore/") + name).c_str(), [world = world](
                                                                                        benchmark::State& state) {
      run(state, world, [](Episode& e) { e.snapshots.restore(e.start); });
    })->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace spark::bench
