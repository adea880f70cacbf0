#pragma once
/// \file
/// Islands of a step: trees that joints and solved contacts connect.

#include <span>
#include <vector>

#include "api/engine.h"
#include "trees.h"

namespace spark::bullet {

/// Elements grouped by island, each group in the order in which they were added.
class Groups {
 public:
  /// `islandOf(i)` of each of `count` elements; kNone: in none.
  template <class IslandOf>
  void build(std::size_t islands, std::size_t count, IslandOf islandOf) {
    first_.assign(islands + 1, 0);
    for (Index i = 0; i < count; ++i)
      if (const Index at = islandOf(i); at != kNone) ++first_[at + 1];
    for (std::size_t i = 0; i < islands; ++i) first_[i + 1] += first_[i];
    items_.resize(first_.back());
    next_.assign(first_.begin(), first_.end());
    for (Index i = 0; i < count; ++i)
      if (const Index at = islandOf(i); at != kNone) items_[next_[at]++] = i;
  }
  std::span<const Index> of(std::size_t island) const {
    return std::span(items_).subspan(first_[island], first_[island + 1] - first_[island]);
  }

 private:
  std::vector<std::size_t> first_, next_;
  std::vector<Index> items_;
};

class Islands {
 public:
  /// `treeOf`: by body. `joints`: those that are in no tree.
  void find(const engine::Step& step, std::size_t trees, const std::vector<Index>& treeOf,
            const std::vector<Index>& joints);
  std::size_t count() const { return active_.size(); }
  /// True: it has a body that is awake, and is to be stepped.
  bool isActive(std::size_t island) const { return active_[island] != 0; }
  std::span<const Index> trees(std::size_t island) const { return trees_.of(island); }
  /// Places in `joints`.
  std::span<const Index> joints(std::size_t island) const { return joints_.of(island); }
  /// Contacts that are solved.
  std::span<const Index> contacts(std::size_t island) const { return contacts_.of(island); }

 private:
  Index rootOf(Index tree);
  void unite(Index a, Index b);
  std::vector<Index> root_;    ///< by tree: disjoint sets
  std::vector<Index> island_;  ///< by tree
  std::vector<std::uint8_t> active_;
  Groups trees_, joints_, contacts_;
};

}  // namespace spark::bullet
