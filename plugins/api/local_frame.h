#pragma once
/// \file
/// World vectors as sensors tell them: in the frame of their own transform.

#include "api/math.h"
#include "spark/abi/api/local_frame.h"

namespace spark {

/// A vector of the world in the frame whose world matrix is `frame` (Transform::world(); only its rotation counts). Any
/// unit; it stays the same. Summed from left to right in single precision, which gives the installed base's digits.
inline Vec3f intoFrame(const Matrix& frame, const Vec3f& v) {
  Vec3f out;
  for (int axis = 0; axis < 3; ++axis)
    out[axis] = (frame(0, axis) * v[0] + frame(1, axis) * v[1]) + frame(2, axis) * v[2];
  return out;
}

}  // namespace spark
