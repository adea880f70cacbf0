#pragma once
/// \file
/// Finds the islands of a step: sets of trees that contacts connect. Islands share no row and can be solved in any
/// order.

#include "disjoint_sets.h"
#include "island_solver.h"

namespace spark::articulated {

/// The awake islands of a step. Memory is kept from step to step.
class IslandBuilder {
 public:
  /// Finds the islands. Islands whose bodies are all asleep are left out.
  void build(const engine::Step& step, const Topology& topology);
  /// Number of awake islands.
  std::size_t size() const { return islands_.size(); }
  /// Island i, 0..size()-1, in order of its first tree. Valid until the next build().
  IslandContents operator[](std::size_t i) const;
  /// Largest number of bodies of an awake island.
  std::size_t maxBodies() const { return maxBodies_; }
  /// Upper bound of the number of rows of an awake island.
  std::size_t maxRows() const { return maxRows_; }
  /// Upper bound of the number of rows of contacts between bodies and of loop joints of an awake island.
  std::size_t maxCouplingRows() const { return maxCouplingRows_; }

 private:
  /// An island: ranges of trees_ and contacts_, and its size.
  struct Range {
    Index firstTree = 0, trees = 0, firstContact = 0, contacts = 0, bodies = 0, couplingRows = 0;
    bool awake = false;
  };
  Range& rangeOf(Index tree) { return ranges_[sets_.find(tree)]; }
  void count(const engine::Step& step, const Topology& topology);
  void layOut();
  void fill(const engine::Step& step, const Topology& topology);
  DisjointSets sets_;                    ///< of trees
  std::vector<Range> ranges_;            ///< by tree; only those of the islands' first trees are used
  std::vector<Index> trees_, contacts_;  ///< island by island
  std::vector<Index> islands_;           ///< first trees of awake islands
  std::size_t maxBodies_ = 0, maxRows_ = 0, maxCouplingRows_ = 0;
};

}  // namespace spark::articulated
