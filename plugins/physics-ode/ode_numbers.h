#pragma once
/// \file
/// Numbers of the engine interface and of ODE: conversion, rounding to single precision, limits.

#include <ode/ode.h>

#include <algorithm>
#include <cmath>

#include "api/math.h"

namespace spark::ode {

/// Rounds N doubles to single precision, in place.
///
/// A conversion to float and back is not enough: g++ 12 vectorises pairs of such conversions and then removes both, as
/// if they cancelled out. The empty assembler statement claims to read and change the floats, so the compiler must
/// store them.
template <int N>
void roundToFloat(double* v) {
  float rounded[N];
  for (int i = 0; i < N; ++i) rounded[i] = static_cast<float>(v[i]);
  __asm__ volatile("" : "+m"(rounded));
  for (int i = 0; i < N; ++i) v[i] = rounded[i];
}
inline double roundToFloat(double v) {
  roundToFloat<1>(&v);
  return v;
}
inline Vec3 roundToFloat(Vec3 v) {
  roundToFloat<3>(v.data());
  return v;
}
inline Mat3 roundToFloat(Mat3 m) {
  roundToFloat<9>(m.data());
  return m;
}

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

/// True when the magnitudes of `n` numbers (m, m/s, rad/s) sum up to less than 1e8; false also for NaN. ODE ends the
/// process when a hash space meets coordinates that do not fit its cells.
inline bool inRange(const dReal* v, int n) {
  dReal sum = 0;
  for (int i = 0; i < n; ++i) sum += std::abs(v[i]);
  return sum < 1e8;
}
inline bool inRange(const Vec3& v) { return inRange(v.data(), 3); }

/// Largest magnitude of forces [N], torques [Nm] and joint parameters that reach ODE. ODE ends the process when a
/// rotation overflows.
inline constexpr double kMaxMagnitude = 1e30;
inline double bounded(double v) { return std::clamp(v, -kMaxMagnitude, kMaxMagnitude); }
inline Vec3 bounded(const Vec3& v) { return v.cwiseMax(-kMaxMagnitude).cwiseMin(kMaxMagnitude); }

/// The composition outer * inner: `inner` is given in the frame of `outer`.
inline Pose compose(const Pose& outer, const Pose& inner) {
  return {outer.position + outer.rotation * inner.position, outer.rotation * inner.rotation};
}

}  // namespace spark::ode
