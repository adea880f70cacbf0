#include "box_tree.h"

#include <algorithm>
#include <numeric>

namespace spark::physics {

void BoxTree::build(std::span<const Box> boxes) {
  nodes_.clear();
  items_.resize(boxes.size());
  std::iota(items_.begin(), items_.end(), 0U);
  if (!boxes.empty()) split(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

/// Makes the node of items_[first..last) and those below it. Returns its index.
std::uint32_t BoxTree::split(std::span<const Box> boxes, std::uint32_t first, std::uint32_t last) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box around = boxes[items_[first]], centers{Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)};
  for (std::uint32_t i = first; i < last; ++i) {
    const Box& box = boxes[items_[i]];
    around = {around.low.cwiseMin(box.low), around.high.cwiseMax(box.high)};
    const Vec3 center = box.low + box.high;  // twice the centre: it is only compared
    centers = {centers.low.cwiseMin(center), centers.high.cwiseMax(center)};
  }
  nodes_[index].box = around;
  if (last - first <= kLeaf) {
    nodes_[index].second = first;
    nodes_[index].items = last - first;
    return index;
  }

  // Halves along the axis on which the centres spread most.
  int axis = 0;
  (centers.high - centers.low).maxCoeff(&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  const auto at = [&](std::uint32_t i) { return boxes[i].low[axis] + boxes[i].high[axis]; };
  std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) { return at(a) < at(b); });
  split(boxes, first, middle);
  const std::uint32_t second = split(boxes, middle, last);
  nodes_[index].second = second;
  return index;
}

}  // namespace spark::physics
