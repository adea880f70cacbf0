#pragma once
/// \file
/// A bounding volume hierarchy: a binary tree of axis-aligned boxes, for queries that meet few of many boxes.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "api/math.h"

namespace spark::physics {

/// An axis-aligned box [m].
struct Box {
  Vec3 low, high;
};

/// Boxes, each with the index that it had in build(). The nodes are stored so that the first child of a node follows
/// it; a leaf holds some items. Const functions may be called by several threads at once.
class BoxTree {
 public:
  /// Builds the tree anew; reuses its memory.
  void build(std::span<const Box> boxes);
  /// The box around all; meaningless while empty() is true.
  Box bounds() const { return nodes_.front().box; }
  bool empty() const { return nodes_.empty(); }
  /// Calls `visit(index)` for the boxes that the ray meets within `nearest` [m], near ones first where that is cheap.
  /// `visit` returns the new `nearest`, at most the old one; a negative number ends the search. `direction` has length
  /// 1. Boxes that the ray only grazes may be visited, too.
  template <class Visit>
  void meet(const Vec3& from, const Vec3& direction, double nearest, Visit&& visit) const;

  /// Calls `visit(index)` for the boxes at most `radius` [m] from `center`, in no order that matters.
  template <class Visit>
  void near(const Vec3& center, double radius, Visit&& visit) const;

 private:
  static constexpr std::uint32_t kLeaf = 4;  ///< most items of a leaf
  static constexpr std::size_t kDepth = 64;  ///< more than any: the tree is balanced, and has 2^32 items at most
  struct Node {
    Box box;
    std::uint32_t second = 0;  ///< index of the second child; of a leaf: of its first item
    std::uint32_t items = 0;   ///< of a leaf; 0: not a leaf
  };
  static constexpr double kMissed = -1;
  /// Distance at which the ray enters a box [m], 0 inside; kMissed where it does not meet it within `nearest`.
  static double entry(const Box& box, const Vec3& from, const Vec3& inverse, double nearest) {
    // The slabs of Kay and Kajiya 1986, "Ray tracing complex scenes". A comparison with NaN (0 * infinity, when the
    // origin is in the plane of a side) keeps the former number.
    double enter = 0, leave = nearest;
    for (int i = 0; i < 3; ++i) {
      double a = (box.low[i] - from[i]) * inverse[i], b = (box.high[i] - from[i]) * inverse[i];
      if (a > b) std::swap(a, b);
      if (a > enter) enter = a;
      if (b < leave) leave = b;
    }
    return enter <= leave ? enter : kMissed;
  }
  std::uint32_t split(std::span<const Box> boxes, std::uint32_t first, std::uint32_t last);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

template <class Visit>
void BoxTree::meet(const Vec3& from, const Vec3& direction, double nearest, Visit&& visit) const {
  if (nodes_.empty()) return;
  const Vec3 inverse = direction.cwiseInverse();
  if (entry(nodes_[0].box, from, inverse, nearest) == kMissed) return;
  std::array<std::pair<std::uint32_t, double>, kDepth> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, 0.0};
  while (count > 0) {
    const auto [index, enters] = waiting[--count];
    if (enters > nearest) continue;
    const Node& node = nodes_[index];
    if (node.items > 0) {
      for (std::uint32_t i = 0; i < node.items; ++i) {
        nearest = visit(items_[node.second + i]);
        if (nearest < 0) return;
      }
      continue;
    }
    // The nearer child is taken from the stack first.
    std::pair<std::uint32_t, double> a{index + 1, entry(nodes_[index + 1].box, from, inverse, nearest)},
        b{node.second, entry(nodes_[node.second].box, from, inverse, nearest)};
    if (a.second < b.second) std::swap(a, b);
    for (const auto& child : {a, b})
      if (child.second != kMissed) waiting[count++] = child;
  }
}

template <class Visit>
void BoxTree::near(const Vec3& center, double radius, Visit&& visit) const {
  if (nodes_.empty()) return;
  const auto isNear = [&](std::uint32_t index) {
    const Box& box = nodes_[index].box;
    return (center - center.cwiseMax(box.low).cwiseMin(box.high)).norm() <= radius;
  };
  std::array<std::uint32_t, kDepth> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t index = waiting[--count];
    if (!isNear(index)) continue;
    const Node& node = nodes_[index];
    for (std::uint32_t i = 0; i < node.items; ++i) visit(items_[node.second + i]);
    if (node.items > 0) continue;
    waiting[count++] = node.second;
    waiting[count++] = index + 1;
  }
}

}  // namespace spark::physics
