#include "stepper.h"

namespace spark::articulated {

Stepper::Kept& Stepper::keptOf(const engine::SolverStep& step) {
  Kept* kept = nullptr;
  for (const auto& world : worlds_)
    if (world->id == step.world) kept = world.get();
  if (!kept) kept = worlds_.emplace_back(std::make_unique<Kept>()).get();
  if (kept->known && kept->structure == step.structure) return *kept;
  kept->id = step.world;
  kept->known = true;
  kept->structure = step.structure;
  kept->topology.find(step);
  kept->memory.assign(step.joints.size(), {});
  kept->firstNode.assign(kept->topology.trees.size(), 0);
  return *kept;
}

void Stepper::forget(engine::World world) {
  std::erase_if(worlds_, [&](const auto& kept) { return kept->id == world; });
}

void Stepper::makeRoom(const Kept& kept, std::size_t threads, int most) {
  while (islandsOfThreads_.size() < threads) islandsOfThreads_.push_back(std::make_unique<Island>(mostPasses));
  // Which island meets which thread is chance: all have room for the largest.
  const Plan& plan = kept.plan;
  const std::size_t coupling = std::min(plan.mostCoupling(), static_cast<std::size_t>(std::max(most, 0)));
  for (const auto& island : islandsOfThreads_)
    island->reserve(plan.mostBodies(), plan.mostRows(), coupling, kept.topology.depth);
}

std::size_t Stepper::countLeft(const engine::SolverStep& step, const Kept& kept) {
  std::size_t bodies = 0;
  for (std::size_t i = 0; i < kept.plan.size(); ++i) {
    if (!kept.left[i]) continue;
    ++deferredIslands_;
    const IslandPlan island = kept.plan[i];
    bodies += island.bodies;
    for (const int t : island.trees) {
      const Tree& tree = kept.topology.trees[static_cast<std::size_t>(t)];
      for (int b = tree.start; b < tree.end; ++b)
        step.bodies[static_cast<std::size_t>(kept.topology.branches[static_cast<std::size_t>(b)].body)]->deferred =
            true;
    }
  }
  return bodies;
}

std::size_t Stepper::step(engine::SolverStep& step, std::size_t threads, const Spread& spread) {
  Kept& kept = keptOf(step);
  for (engine::SolverBody* body : step.bodies) body->deferred = false;
  kept.plan.find(step, kept.topology);
  const std::size_t n = kept.plan.size();
  if (n == 0) return 0;
  step.maxCouplingRows = std::min(step.maxCouplingRows, mostRows);
  makeRoom(kept, threads, step.maxCouplingRows);
  kept.left.assign(n, 0);
  islands_ += static_cast<std::int64_t>(n);
  kept.contacts.match(step.contacts);
  WorldView world{step, kept.topology, kept.memory, kept.contacts, kept.firstNode};
  std::atomic<std::size_t> next{0};
  const auto work = [&](std::size_t thread) {
    Island& island = *islandsOfThreads_[thread];
    for (std::size_t i = next.fetch_add(1); i < n; i = next.fetch_add(1))
      kept.left[i] = !island.step(world, kept.plan[i]);
  };
  if (threads < 2 || n < 2)
    work(0);
  else
    spread(std::min(threads, n), work);
  return countLeft(step, kept);
}

std::int64_t Stepper::passes() const {
  std::int64_t sum = 0;
  for (const auto& island : islandsOfThreads_) sum += island->pivoting().passes;
  return sum;
}

std::int64_t Stepper::exactSolutions() const {
  std::int64_t sum = 0;
  for (const auto& island : islandsOfThreads_) sum += island->pivoting().exactSolutions;
  return sum;
}

}  // namespace spark::articulated
