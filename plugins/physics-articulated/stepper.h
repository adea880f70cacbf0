#pragma once
/// \file
/// Steps whole worlds: keeps what outlives a step, and distributes islands over threads.

#include <functional>
#include <memory>

#include "island_builder.h"

namespace spark::articulated {

/// Calls work(i) once for each i in [0, n), each in any thread, and returns when all calls have returned.
using ParallelFor = std::function<void(std::size_t n, const std::function<void(std::size_t)>& work)>;

/// Steps worlds. One thread at a time calls it.
class Stepper {
 public:
  std::uint32_t maxPasses = 30;  ///< see Pivoting; to be set before the first step
  int maxCouplingRows = 600;     ///< islands with more coupling rows are to be deferred; at least 0

  /// Steps the world (see IEngine::step) with up to `threads` threads, at least 1; results do not depend on their
  /// number. `parallelFor` may be empty if `threads` is 1. Islands with more than `mostRows` coupling rows, and those
  /// without a solution, are deferred and left unchanged. Returns which bodies are in them (see Step::only); empty:
  /// none. Valid until the next step.
  std::span<const std::uint8_t> step(engine::Step& step, int mostRows, std::size_t threads,
                                     const ParallelFor& parallelFor);
  /// Drops what is kept for a world.
  void forget(const engine::Model& model);

  /// Number of awake islands since construction, deferred ones included.
  std::int64_t islands() const { return islands_; }
  /// Number of passes of pivoting since construction.
  std::int64_t passes() const;
  /// Number of searches since construction that used Dantzig's algorithm.
  std::int64_t exactSolutions() const;
  /// Number of deferred islands since construction.
  std::int64_t deferredIslands() const { return deferredIslands_; }

 private:
  /// What is kept for a world between steps, and memory that its steps use.
  struct WorldData {
    std::uint64_t id = 0;
    bool built = false;           ///< topology is that of `structure`
    std::uint64_t structure = 0;  ///< Model::structure
    Topology topology;
    std::vector<JointWarmStart> joints;
    ContactWarmStart contacts;
    std::vector<Index> firstNode;  ///< see WorldView
    IslandBuilder islands;
    std::vector<char> deferred;                ///< by island of the step
    std::vector<std::uint8_t> deferredBodies;  ///< by body of the step
  };
  WorldData& worldOf(const engine::Model& model);
  void reserve(const WorldData& world, std::size_t threads, int couplingRows);
  bool markDeferred(WorldData& world);
  std::vector<std::unique_ptr<WorldData>> worlds_;
  std::vector<std::unique_ptr<IslandSolver>> solvers_;  ///< by thread
  std::int64_t islands_ = 0, deferredIslands_ = 0;
};

}  // namespace spark::articulated
