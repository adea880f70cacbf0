#pragma once
/// \file
/// Rounding to single precision, in which the installed base keeps the numbers that cross its engine's interface.

#include "api/math.h"
#include "spark/abi/api/single_precision.h"

namespace spark {

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

}  // namespace spark
