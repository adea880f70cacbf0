#include "stepper.h"

#include <atomic>

namespace spark::articulated {

void Stepper::compile(const engine::Model& model) {
  engine::readSoftness(model, softness_);
  if (built_ && structure_ == model.structure) return;
  built_ = true;
  structure_ = model.structure;
  topology_.build(model);
  joints_.assign(model.joints.size(), {});
  firstNode_.assign(topology_.trees.size(), 0);
  deferredBodies_.assign(model.bodies.size(), 0);
}

/// Allocates memory for the islands of the step. Which thread gets which island is not fixed: each has room for the
/// largest one. Islands with more than `couplingRows` coupling rows are deferred and need no room for them.
void Stepper::reserve(std::size_t threads, int couplingRows) {
  while (solvers_.size() < threads) solvers_.push_back(std::make_unique<IslandSolver>(maxPasses));
  const IslandBuilder& islands = islandList_;
  const std::size_t coupling = std::min(islands.maxCouplingRows(), static_cast<std::size_t>(std::max(couplingRows, 0)));
  for (const auto& solver : solvers_)
    solver->reserve(islands.maxBodies(), islands.maxRows(), coupling, topology_.maxDepth);
}

/// Marks the bodies of deferred islands. Returns whether there are any.
bool Stepper::markDeferred() {
  bool any = false;
  for (std::size_t i = 0; i < islandList_.size(); ++i) {
    if (!deferred_[i]) continue;
    if (!std::exchange(any, true)) std::fill(deferredBodies_.begin(), deferredBodies_.end(), 0);
    ++deferredIslands_;
    for (const Index t : islandList_[i].trees) {
      const Tree& tree = topology_.trees[t];
      for (Index b = tree.begin; b < tree.end; ++b) deferredBodies_[topology_.treeBodies[b].body] = 1;
    }
  }
  return any;
}

std::span<const std::uint8_t> Stepper::step(engine::Step& step, int mostRows, std::size_t threads,
                                            const ParallelFor& parallelFor) {
  islandList_.build(step, topology_);
  const std::size_t n = islandList_.size();
  if (n == 0) return {};
  // Prepare all that the threads share or must not allocate.
  reserve(threads, mostRows);
  deferred_.assign(n, 0);
  islands_ += static_cast<std::int64_t>(n);
  contacts_.match(step.contacts);
  laws_.list(step.state);
  WorldView view{step, mostRows, topology_, softness_, joints_, laws_, contacts_, firstNode_};
  // Each thread takes the next island until none remains.
  std::atomic<std::size_t> next{0};
  const auto work = [&](std::size_t thread) {
    IslandSolver& solver = *solvers_[thread];
    for (std::size_t i = next.fetch_add(1); i < n; i = next.fetch_add(1))
      deferred_[i] = !solver.step(view, islandList_[i]);
  };
  if (threads < 2 || n < 2)
    work(0);
  else
    parallelFor(std::min(threads, n), work);

  const bool some = markDeferred();
  for (Index i = 0; i < step.state.bodies.size(); ++i)
    if (step.state.bodies[i].awake && step.steps(i) && !(some && deferredBodies_[i])) step.state.markMoved(i);
  return some ? std::span<const std::uint8_t>(deferredBodies_) : std::span<const std::uint8_t>();
}

Stepper::Counts Stepper::counts() const {
  Counts out{islands_, 0, 0, deferredIslands_};
  for (const auto& solver : solvers_) {
    out.passes += solver->pivoting().passes;
    out.exactSolutions += solver->pivoting().exactSolutions;
  }
  return out;
}

}  // namespace spark::articulated
