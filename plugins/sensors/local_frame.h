#pragma once

#include "api/math.h"

namespace spark {

/// A world vector in a transform's frame, summed from left to right in single precision: the installed base's digits.
inline Vec3f intoFrame(const Matrix& frame, const Vec3f& v) {
  Vec3f out;
  for (int axis = 0; axis < 3; ++axis) out[axis] = (frame(0, axis) * v[0] + frame(1, axis) * v[1]) + frame(2, axis) * v[2];
  return out;
}

}  // namespace spark
