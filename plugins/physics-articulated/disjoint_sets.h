#pragma once
/// \file
/// Union-find.

#include <algorithm>
#include <vector>

#include "index.h"

namespace spark::articulated {

/// Sets of the numbers 0..n-1, which only grow together. The smallest member of a set represents it, whatever the order
/// of the merges. Memory is kept from use to use.
class DisjointSets {
 public:
  /// Puts each of 0..n-1 into a set of its own.
  void reset(std::size_t n) {
    parent_.resize(n);
    for (std::size_t i = 0; i < n; ++i) parent_[i] = toIndex(i);
  }
  /// The smallest member of the set of `i`.
  Index find(Index i) {
    // Path halving (Tarjan and van Leeuwen 1984): each visited element skips to its grandparent.
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  /// Merges the sets of `a` and `b`.
  void merge(Index a, Index b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace spark::articulated
