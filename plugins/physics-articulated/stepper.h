#pragma once
/// \file
/// Steps whole worlds: keeps what outlives a step, and spreads islands over threads.

#include <atomic>
#include <memory>

#include "plan.h"

namespace spark::articulated {

/// Calls work(i) for all i in [0, n), in any threads.
using Spread = std::function<void(std::size_t n, const std::function<void(std::size_t)>& work)>;

class Stepper {
 public:
  int mostPasses = 30;
  /// Islands with more rows that are no part of a tree are left to the engine.
  int mostRows = 600;

  /// Steps the world with up to `threads` threads; the result is the same with any number. Returns how many bodies are
  /// left to the engine.
  std::size_t step(engine::SolverStep& step, std::size_t threads, const Spread& spread);
  void forget(engine::World world);
  /// Since the stepper was made: searches for what holds, their passes, searches that needed the exact way, islands
  /// left.
  std::int64_t islands() const { return islands_; }
  std::int64_t passes() const;
  std::int64_t exactSolutions() const;
  std::int64_t deferredIslands() const { return deferredIslands_; }

 private:
  /// What a world keeps between steps.
  struct Kept {
    engine::World id = engine::World::none;
    bool known = false;
    std::uint64_t structure = 0;
    Topology topology;
    std::vector<JointMemory> memory;
    ContactMemory contacts;
    std::vector<int> firstNode;
    Plan plan;
    std::vector<char> left;  ///< by island of the step
  };
  Kept& keptOf(const engine::SolverStep& step);
  /// `most`: coupling rows of an island that is not left.
  void makeRoom(const Kept& kept, std::size_t threads, int most);
  std::size_t countLeft(const engine::SolverStep& step, const Kept& kept);
  std::vector<std::unique_ptr<Kept>> worlds_;
  std::vector<std::unique_ptr<Island>> islandsOfThreads_;
  std::int64_t islands_ = 0, deferredIslands_ = 0;
};

}  // namespace spark::articulated
