#pragma once
/// \file
/// What hangs together in a step: islands of trees and contacts, and which of them are awake.

#include "island.h"

namespace spark::articulated {

class Plan {
 public:
  /// Finds the islands of this step. Islands in which nothing is awake are left out.
  void find(const engine::SolverStep& step, const Topology& topology);
  std::size_t size() const { return islands_.size(); }
  IslandPlan operator[](std::size_t i) const;
  /// Of the largest island.
  std::size_t mostBodies() const { return mostBodies_; }
  std::size_t mostRows() const { return mostRows_; }
  /// Of contacts between bodies, and of joints that close loops, in the island that has most.
  std::size_t mostCoupling() const { return mostCoupling_; }

 private:
  struct Range {
    int firstTree = 0, trees = 0, firstContact = 0, contacts = 0, bodies = 0, coupling = 0;
    bool awake = false;
  };
  int rootOf(int tree);
  void unite(int a, int b);
  std::vector<int> above_;             ///< by tree, towards the first tree of its island
  std::vector<Range> ranges_;          ///< by first tree
  std::vector<int> trees_, contacts_;  ///< island by island
  std::vector<int> islands_;           ///< first trees of awake islands
  std::size_t mostBodies_ = 0, mostRows_ = 0, mostCoupling_ = 0;
};

}  // namespace spark::articulated
