#pragma once
/// \file
/// Six-vectors (a velocity with its spin, a force with its torque), blocks of 6 x 6 and their factors. All sizes are
/// fixed; numbers are worked on in pairs, which every x86-64 has (and other processors have the like), always in the
/// same order.

#include "api/math.h"

namespace spark::articulated {

using Pair = double __attribute__((vector_size(16)));

/// Linear part first.
struct Six {
  Pair p[3];
  static Six of(const Vec3& linear, const Vec3& angular) {
    Six out;
    out.p[0] = Pair{linear.x(), linear.y()};
    out.p[1] = Pair{linear.z(), angular.x()};
    out.p[2] = Pair{angular.y(), angular.z()};
    return out;
  }
  static Six zero() { return {}; }
  double operator[](int i) const { return p[i >> 1][i & 1]; }
  void set(int i, double v) { p[i >> 1][i & 1] = v; }
  Vec3 linear() const { return {p[0][0], p[0][1], p[1][0]}; }
  Vec3 angular() const { return {p[1][1], p[2][0], p[2][1]}; }
  Six& operator+=(const Six& o) {
    for (int i = 0; i < 3; ++i) p[i] += o.p[i];
    return *this;
  }
  /// Adds f times o.
  void add(const Six& o, double f) {
    for (int i = 0; i < 3; ++i) p[i] += o.p[i] * Pair{f, f};
  }
  void subtract(const Six& o, double f) {
    for (int i = 0; i < 3; ++i) p[i] -= o.p[i] * Pair{f, f};
  }
};

inline Six operator*(const Six& a, double f) {
  Six out;
  for (int i = 0; i < 3; ++i) out.p[i] = a.p[i] * Pair{f, f};
  return out;
}
/// Element by element.
inline Six operator*(const Six& a, const Six& b) {
  Six out;
  for (int i = 0; i < 3; ++i) out.p[i] = a.p[i] * b.p[i];
  return out;
}
inline Six operator-(const Six& a, const Six& b) {
  Six out;
  for (int i = 0; i < 3; ++i) out.p[i] = a.p[i] - b.p[i];
  return out;
}
inline double dot(const Six& a, const Six& b) {
  const Pair sum = a.p[0] * b.p[0] + a.p[1] * b.p[1] + a.p[2] * b.p[2];
  return sum[0] + sum[1];
}

/// 6 x 6. Where it is symmetric, only what stands on and above the diagonal counts: in row i, the pairs from i / 2 on.
struct Block {
  Six row[6];
};

/// Adds f v v^T to a symmetric block.
inline void addSquare(Block& m, const Six& v, double f) {
  const Six scaled = v * f;
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i)
#pragma GCC unroll 3
    for (int p = i / 2; p < 3; ++p) m.row[i].p[p] += scaled.p[p] * Pair{v[i], v[i]};
}

/// m x.
inline Six times(const Block& m, const Six& x) {
  Six out;
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) out.set(i, dot(m.row[i], x));
  return out;
}

/// m^T x.
inline Six timesTransposed(const Block& m, const Six& x) {
  Six out = m.row[0] * x[0];
#pragma GCC unroll 6
  for (int i = 1; i < 6; ++i) out.add(m.row[i], x[i]);
  return out;
}

/// A symmetric positive semidefinite block as L D L^T.
struct Factor {
  Six column[6];  ///< of L below its diagonal of ones; zero elsewhere
  Six inverse;    ///< of D. A direction without resistance has 0: nothing moves or pushes along it

  /// Takes `m` apart; `m` is used up.
  void take(Block& m) {
    // What elimination leaves of a redundant direction is rounding.
    constexpr double kRounding = 1e-14;
    Six least;
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) least.set(k, kRounding * m.row[k][k]);
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) {
      const double pivot = m.row[k][k];
      const double reciprocal = pivot > least[k] ? 1 / pivot : 0;
      inverse.set(k, reciprocal);
      Six c = m.row[k] * reciprocal;
#pragma GCC unroll 6
      for (int i = 0; i <= k; ++i) c.set(i, 0);
      column[k] = c;
#pragma GCC unroll 6
      for (int i = k + 1; i < 6; ++i) {
        const double f = m.row[k][i];
#pragma GCC unroll 3
        for (int p = i / 2; p < 3; ++p) m.row[i].p[p] -= c.p[p] * Pair{f, f};
      }
    }
  }

  /// L^-1 x.
  void forward(Six& x) const {
#pragma GCC unroll 6
    for (int k = 0; k < 5; ++k) x.subtract(column[k], x[k]);
  }
  /// L^-1 m, columns of m side by side.
  void forward(Block& m) const {
#pragma GCC unroll 6
    for (int k = 0; k < 5; ++k)
#pragma GCC unroll 6
      for (int i = k + 1; i < 6; ++i) m.row[i].subtract(m.row[k], column[k][i]);
  }
  /// L^-T x.
  void backward(Six& x) const {
#pragma GCC unroll 6
    for (int k = 4; k >= 0; --k) x.set(k, x[k] - dot(column[k], x));
  }
};

/// m^T diag(d) m, added to a symmetric block.
inline void addCongruence(Block& to, const Block& m, const Six& d) {
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    const Six scaled = m.row[k] * d[k];
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i)
#pragma GCC unroll 3
      for (int p = i / 2; p < 3; ++p) to.row[i].p[p] += scaled.p[p] * Pair{m.row[k][i], m.row[k][i]};
  }
}

}  // namespace spark::articulated
