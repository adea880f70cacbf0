#pragma once
/// \file
/// Do two boxes overlap? Separating axes: two convex bodies overlap as deep as their shadows do on the direction where these overlap
/// least; for boxes that is one of 3 + 3 face normals or 9 cross products of edges (S. Gottschalk, Collision Queries using Oriented
/// Bounding Boxes, 2000, chapter 5).

#include "api/math.h"

namespace spark::soccer {

/// True when the boxes overlap by more than `tolerance` [m] along every direction. `halfA`, `halfB`: half of their edges [m].
inline bool overlapBeyond(double tolerance, const Pose& a, const Vec3& halfA, const Pose& b, const Vec3& halfB) {
  // everything in a's frame
  const Mat3 r = a.rotation.transpose() * b.rotation;
  const Mat3 absR = r.cwiseAbs();
  const Vec3 t = a.rotation.transpose() * (b.position - a.position);
  const Vec3 faceA = halfA + absR * halfB - t.cwiseAbs();
  if (faceA.minCoeff() <= tolerance) return false;
  const Vec3 faceB = halfB + absR.transpose() * halfA - (r.transpose() * t).cwiseAbs();
  if (faceB.minCoeff() <= tolerance) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double length = std::sqrt(std::max(0.0, 1 - r(i, j) * r(i, j)));
      if (length < 1e-6) continue;  // parallel edges: a face normal says it
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double shadows = halfA[i1] * absR(i2, j) + halfA[i2] * absR(i1, j) + halfB[j1] * absR(i, j2) + halfB[j2] * absR(i, j1);
      if (shadows - std::abs(t[i2] * r(i1, j) - t[i1] * r(i2, j)) <= tolerance * length) return false;
    }
  return true;
}

}  // namespace spark::soccer
