#pragma once
/// \file
/// Conversion of world vectors into the frame of a sensor.

#include "api/math.h"
#include "spark/abi/api/local_frame.h"

namespace spark {

/// Rotates the world vector `v` into the frame with the world matrix `frame` (Transform::world()): R^T v, the
/// translation is ignored. The unit of `v` is kept. Summed from left to right in single precision, as the installed
/// base does, so that the digits agree.
inline Vec3f intoFrame(const Matrix& frame, const Vec3f& v) {
  Vec3f out;
  for (int axis = 0; axis < 3; ++axis)
    out[axis] = (frame(0, axis) * v[0] + frame(1, axis) * v[1]) + frame(2, axis) * v[2];
  return out;
}

}  // namespace spark
