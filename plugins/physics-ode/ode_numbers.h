#pragma once
/// \file
/// Vectors and matrices of ODE.

#include <ode/ode.h>

#include "api/math.h"

namespace spark::ode {

/// The first three elements of an ODE vector.
inline Vec3 toVec(const dReal* v) { return {v[0], v[1], v[2]}; }
/// An ODE rotation matrix, which is stored as 3 rows of 4 elements, the fourth unused.
inline Mat3 toMat(const dReal* r) {
  Mat3 m;
  m << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return m;
}
/// Writes a rotation or inertia matrix in ODE's layout: 12 elements.
inline void toOde(const Mat3& m, dReal* r) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) r[4 * row + column] = m(row, column);
    r[4 * row + 3] = 0;
  }
}

}  // namespace spark::ode
