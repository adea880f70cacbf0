#pragma once
/// \file
/// Steps a whole world: keeps what outlives a step, and distributes islands over threads.

#include <functional>
#include <memory>

#include "island_builder.h"

namespace spark::articulated {

/// Calls work(i) once for each i in [0, n), each in any thread, and returns when all calls have returned.
using ParallelFor = std::function<void(std::size_t n, const std::function<void(std::size_t)>& work)>;

/// Steps one world. One thread at a time calls it.
class Stepper {
 public:
  std::uint32_t maxPasses = 30;  ///< see Pivoting; to be set before the first step

  /// Brings what is kept to the present model (see ISolver::compile).
  void compile(const engine::Model& model);
  /// Steps the world (see ISolver::step) with up to `threads` threads, at least 1; results do not depend on their
  /// number. `parallelFor` may be empty if `threads` is 1. Islands with more than `mostRows` coupling rows, and those
  /// without a solution, are deferred and left unchanged. Returns which bodies are in them (see Step::only); empty:
  /// none. Valid until the next step.
  std::span<const std::uint8_t> step(engine::Step& step, int mostRows, std::size_t threads,
                                     const ParallelFor& parallelFor);

  /// What was counted since construction.
  struct Counts {
    std::int64_t islands = 0;         ///< awake ones, deferred ones included
    std::int64_t passes = 0;          ///< of pivoting
    std::int64_t exactSolutions = 0;  ///< searches that used Dantzig's algorithm
    std::int64_t deferredIslands = 0;
    void operator+=(const Counts& o) {
      islands += o.islands, passes += o.passes, exactSolutions += o.exactSolutions,
          deferredIslands += o.deferredIslands;
    }
    Counts operator-(const Counts& o) const {
      return {islands - o.islands, passes - o.passes, exactSolutions - o.exactSolutions,
              deferredIslands - o.deferredIslands};
    }
  };
  Counts counts() const;

 private:
  void reserve(std::size_t threads, int couplingRows);
  bool markDeferred();
  bool built_ = false;           ///< topology is that of `structure_`
  std::uint64_t structure_ = 0;  ///< Model::structure
  Topology topology_;
  std::vector<engine::JointSoftness> softness_;  ///< by joint
  std::vector<JointWarmStart> joints_;
  ContactWarmStart contacts_;
  engine::LawsByJoint laws_;
  std::vector<Index> firstNode_;  ///< see WorldView
  IslandBuilder islandList_;
  std::vector<char> deferred_;                          ///< by island of the step
  std::vector<std::uint8_t> deferredBodies_;            ///< by body of the step
  std::vector<std::unique_ptr<IslandSolver>> solvers_;  ///< by thread
  std::int64_t islands_ = 0, deferredIslands_ = 0;
};

}  // namespace spark::articulated
