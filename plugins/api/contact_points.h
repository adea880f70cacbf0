#pragma once
/// \file
/// Which contact points of a pair an engine keeps when it has found more than it may report.

#include <algorithm>
#include <cmath>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/contact_points.h"

namespace spark::engine {

/// Chooses `most` of `count` points, at least 1 and fewer than `count`: the deepest, then each time the one that is
/// farthest from those that were chosen, so that what lies on them does not tip. Then `apart[i]` is below 0 for those.
/// `position(i)` is in m, `depth(i)` likewise.
template <class Position, class Depth>
void choosePoints(std::size_t count, std::size_t most, Position position, Depth depth, std::vector<double>& apart) {
  std::size_t next = 0;
  for (std::size_t i = 1; i < count; ++i)
    if (depth(i) > depth(next)) next = i;
  apart.assign(count, HUGE_VAL);
  for (std::size_t n = 0; n < most; ++n) {
    apart[next] = -1;
    const Vec3 chosen = position(next);
    for (std::size_t i = 0; i < count; ++i)
      if (apart[i] >= 0) apart[i] = std::min(apart[i], (position(i) - chosen).squaredNorm());
    next = static_cast<std::size_t>(std::max_element(apart.begin(), apart.end()) - apart.begin());
  }
}

}  // namespace spark::engine
