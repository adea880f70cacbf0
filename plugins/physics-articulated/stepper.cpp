#include "stepper.h"

#include <atomic>

namespace spark::articulated {

/// What is kept for the world of a step, with the topology of its present structure.
Stepper::WorldData& Stepper::worldOf(const engine::SolverStep& step) {
  WorldData* world = nullptr;
  for (const auto& w : worlds_)
    if (w->id == step.world) world = w.get();
  if (!world) world = worlds_.emplace_back(std::make_unique<WorldData>()).get();
  if (world->built && world->structure == step.structure) return *world;
  world->id = step.world;
  world->built = true;
  world->structure = step.structure;
  world->topology.build(step);
  world->joints.assign(step.joints.size(), {});
  world->firstNode.assign(world->topology.trees.size(), 0);
  return *world;
}

void Stepper::forget(engine::World world) {
  std::erase_if(worlds_, [&](const auto& w) { return w->id == world; });
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

/// Marks the bodies of deferred islands, and returns their number.
std::size_t Stepper::markDeferred(const engine::SolverStep& step, const WorldData& world) {
  std::size_t bodies = 0;
  for (std::size_t i = 0; i < world.islands.size(); ++i) {
    if (!world.deferred[i]) continue;
    ++deferredIslands_;
    const IslandContents island = world.islands[i];
    bodies += island.bodies;
    for (const Index t : island.trees) {
      const Tree& tree = world.topology.trees[t];
      for (Index b = tree.begin; b < tree.end; ++b) step.bodies[world.topology.treeBodies[b].body]->deferred = true;
    }
  }
  return bodies;
}

std::size_t Stepper::step(engine::SolverStep& step, std::size_t threads, const ParallelFor& parallelFor) {
  WorldData& world = worldOf(step);
  for (engine::SolverBody* body : step.bodies) body->deferred = false;
  world.islands.build(step, world.topology);
  const std::size_t n = world.islands.size();
  if (n == 0) return 0;
  // Prepare all that the threads share or must not allocate.
  step.maxCouplingRows = std::min(step.maxCouplingRows, maxCouplingRows);
  reserve(world, threads, step.maxCouplingRows);
  world.deferred.assign(n, 0);
  islands_ += static_cast<std::int64_t>(n);
  world.contacts.match(step.contacts);
  WorldView view{step, world.topology, world.joints, world.contacts, world.firstNode};
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
  return markDeferred(step, world);
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
