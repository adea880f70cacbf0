#include <benchmark/benchmark.h>

#include "api/agents.h"
#include "api/physics.h"
#include "house.h"
#include "micro.h"

// The cost of the rays of 22 humanoids in a cycle: 64 each, in all directions of the horizontal plane at the height of
// a head. Every cycle begins with a body that has moved, so that it pays for the preparation.

namespace spark::bench {

namespace {

constexpr int kRays = 64;
constexpr double kRange = 10;  // m

struct Field {
  LocalEntrance entrance;
  Instance instance;
  IPhysicsServer& physics;
  const std::vector<AgentAspect*>& agents;
  std::vector<Vec3> eyes;
  IRigidBody* body;

  explicit Field(const World& world)
      : instance({world}, entrance),
        physics(instance.kernel().root().require<IPhysicsServer>()),
        agents(instance.kernel().root().require<IGameControl>().agents()) {
    for (AgentAspect* agent : agents) {
      std::vector<IRigidBody*> bodies;
      physics.bodies(*agent, bodies);
      eyes.push_back(bodies.front()->state().position + Vec3(0, 0, 0.15));
      body = bodies.front();
    }
  }
  /// Number of rays that met something.
  int cycle() {
    body->setPosition(body->state().position);
    physics.prepareRays();
    int met = 0;
    for (std::size_t i = 0; i < agents.size(); ++i)
      for (int ray = 0; ray < kRays; ++ray) {
        const double angle = 2 * kPi * ray / kRays;
        met += physics.castRay(eyes[i], {std::cos(angle), std::sin(angle), 0}, kRange, agents[i]).has_value();
      }
    return met;
  }
};

}  // namespace

void registerRays() {
  benchmark::RegisterBenchmark("rays/22x64", [](benchmark::State& state) {
    Field field(worldOf("rest22"));
    int met = 0;
    for (auto _ : state) met = field.cycle();
    state.counters["rays"] = static_cast<double>(field.agents.size() * kRays);
    state.counters["met"] = met;
  })->Unit(benchmark::kMicrosecond);
}

}  // namespace spark::bench
