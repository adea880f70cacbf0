#include "stepper.h"

#include <atomic>

namespace spark::articulated {

/// What is kept for a world, with the topology of its present structure.
Stepper::WorldData& Stepper::worldOf(const engine::Model& model) {
  WorldData* world = nullptr;
  for (const auto& w : worlds_)
    if (w->id == model.id) world = w.get();
  if (!world) world = worlds_.emplace_back(std::make_unique<WorldData>()).get();
  if (world->built && world->structure == model.structure) return *world;
  world->id = model.id;
  world->built = true;
  world->structure = model.structure;
  world->topology.build(model);
  world->joints.assign(model.joints.size(), {});
  world->firstNode.assign(world->topology.trees.size(), 0);
  world->deferredBodies.assign(model.bodies.size(), 0);
  return *world;
}

void Stepper::forget(const engine::Model& model) {
  std::erase_if(worlds_, [&](const auto& w) { return w->id == model.id; });
}

/// Allocates memory for the islands of the step. Which thread gets which island is not fixed: each has room for the
/// largest one. Islands with more than `couplingRows` coupling rows are deferred and need no room for them.
void Stepper::reserve(const WorldData& world, std::size_t threads, int couplingRows) {
  while (solvers_.size() < threads) solvers_.push_back(std::make_unique<IslandSolver>(maxPasses));
  const IslandBuilder& islands = world.islands;
  const std::size_t coupling = std::min(islands.maxCouplingRows(), static_cast<std::size_t>(std::max(couplingRows, 0)));
  for (const auto& solver : solvers_)
    solver->reserve(islands.maxBodies(), islands.maxRows(), coupling, world.topology.maxDepth);
}

/// Marks the bodies of deferred islands. Returns whether there are any.
bool Stepper::markDeferred(WorldData& world) {
  bool any = false;
  for (std::size_t i = 0; i < world.islands.size(); ++i) {
    if (!world.deferred[i]) continue;
    if (!std::exchange(any, true)) std::fill(world.deferredBodies.begin(), world.deferredBodies.end(), 0);
    ++deferredIslands_;
    for (const Index t : world.islands[i].trees) {
      const Tree& tree = world.topology.trees[t];
      for (Index b = tree.begin; b < tree.end; ++b) world.deferredBodies[world.topology.treeBodies[b].body] = 1;
    }
  }
  return any;
}

std::span<const std::uint8_t> Stepper::step(engine::Step& step, int mostRows, std::size_t threads,
                                            const ParallelFor& parallelFor) {
  WorldData& world = worldOf(step.model);
  world.islands.build(step, world.topology);
  const std::size_t n = world.islands.size();
  if (n == 0) return {};
  // Prepare all that the threads share or must not allocate.
  reserve(world, threads, mostRows);
  world.deferred.assign(n, 0);
  islands_ += static_cast<std::int64_t>(n);
  world.contacts.match(step.contacts);
  WorldView view{step, mostRows, world.topology, world.joints, world.contacts, world.firstNode};
  // Each thread takes the next island until none remains.
  std::atomic<std::size_t> next{0};
  const auto work = [&](std::size_t thread) {
    IslandSolver& solver = *solvers_[thread];
    for (std::size_t i = next.fetch_add(1); i < n; i = next.fetch_add(1))
      world.deferred[i] = !solver.step(view, world.islands[i]);
  };
  if (threads < 2 || n < 2)
    work(0);
  else
    parallelFor(std::min(threads, n), work);

  const bool some = markDeferred(world);
  for (Index i = 0; i < step.state.bodies.size(); ++i)
    if (step.state.bodies[i].awake && step.steps(i) && !(some && world.deferredBodies[i])) step.state.markMoved(i);
  return some ? std::span<const std::uint8_t>(world.deferredBodies) : std::span<const std::uint8_t>();
}

std::int64_t Stepper::passes() const {
  std::int64_t sum = 0;
  for (const auto& solver : solvers_) sum += solver->pivoting().passes;
  return sum;
}

std::int64_t Stepper::exactSolutions() const {
  std::int64_t sum = 0;
  for (const auto& solver : solvers_) sum += solver->pivoting().exactSolutions;
  return sum;
}

}  // namespace spark::articulated
