#pragma once
/// \file
/// Spatial vectors, 6 x 6 matrices and their LDL^T factors.
///
/// A spatial vector joins a linear and an angular quantity: a velocity with an angular velocity, or a force with a
/// torque (Featherstone 2008, Rigid Body Dynamics Algorithms, chapter 2). Unlike Featherstone's, vectors here have the
/// linear part first, are in world axes and refer to the body's centre of mass. So a body's inertia is block diagonal,
/// and no vector needs a transform from one body's frame to the next.
///
/// All sizes are fixed. The arithmetic works on pairs of doubles, which every x86-64 processor has (SSE2), and always
/// in the same order: results do not depend on the processor.

#include "api/math.h"

namespace spark::articulated {

/// Two doubles that one instruction works on.
using DoublePair = double __attribute__((vector_size(16)));

/// Six elements: linear x y z, angular x y z.
struct SpatialVector {
  DoublePair pair[3];  ///< elements 0 1, 2 3, 4 5

  /// A motion of a velocity and an angular velocity, or a force of a force and a torque.
  static SpatialVector of(const Vec3& linear, const Vec3& angular) {
    SpatialVector out;
    out.pair[0] = DoublePair{linear.x(), linear.y()};
    out.pair[1] = DoublePair{linear.z(), angular.x()};
    out.pair[2] = DoublePair{angular.y(), angular.z()};
    return out;
  }
  static SpatialVector zero() { return {}; }
  /// Element i, 0..5.
  double operator[](int i) const { return pair[i >> 1][i & 1]; }
  /// Sets element i, 0..5.
  void set(int i, double v) { pair[i >> 1][i & 1] = v; }
  Vec3 linear() const { return {pair[0][0], pair[0][1], pair[1][0]}; }
  Vec3 angular() const { return {pair[1][1], pair[2][0], pair[2][1]}; }
  SpatialVector& operator+=(const SpatialVector& o) {
    for (int i = 0; i < 3; ++i) pair[i] += o.pair[i];
    return *this;
  }
  /// Adds s o.
  void addScaled(const SpatialVector& o, double s) {
    for (int i = 0; i < 3; ++i) pair[i] += o.pair[i] * DoublePair{s, s};
  }
  /// Subtracts s o.
  void subtractScaled(const SpatialVector& o, double s) {
    for (int i = 0; i < 3; ++i) pair[i] -= o.pair[i] * DoublePair{s, s};
  }
};

inline SpatialVector operator*(const SpatialVector& a, double s) {
  SpatialVector out;
  for (int i = 0; i < 3; ++i) out.pair[i] = a.pair[i] * DoublePair{s, s};
  return out;
}
/// Product element by element: diag(a) b.
inline SpatialVector operator*(const SpatialVector& a, const SpatialVector& b) {
  SpatialVector out;
  for (int i = 0; i < 3; ++i) out.pair[i] = a.pair[i] * b.pair[i];
  return out;
}
inline SpatialVector operator-(const SpatialVector& a, const SpatialVector& b) {
  SpatialVector out;
  for (int i = 0; i < 3; ++i) out.pair[i] = a.pair[i] - b.pair[i];
  return out;
}
/// The scalar product. Sums the even and the odd elements first, then the two sums.
inline double dot(const SpatialVector& a, const SpatialVector& b) {
  const DoublePair sum = a.pair[0] * b.pair[0] + a.pair[1] * b.pair[1] + a.pair[2] * b.pair[2];
  return sum[0] + sum[1];
}

/// A 6 x 6 matrix by rows. Of a symmetric matrix only the upper triangle is valid: in row i, the pairs from i / 2 on.
struct SpatialMatrix {
  SpatialVector row[6];
};

/// M += s v v^T, M symmetric.
inline void addOuterProduct(SpatialMatrix& m, const SpatialVector& v, double s) {
  const SpatialVector scaled = v * s;
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i)
#pragma GCC unroll 3
    for (int p = i / 2; p < 3; ++p) m.row[i].pair[p] += scaled.pair[p] * DoublePair{v[i], v[i]};
}

/// S += M^T diag(d) M, S symmetric.
inline void addCongruence(SpatialMatrix& s, const SpatialMatrix& m, const SpatialVector& d) {
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    const SpatialVector scaled = m.row[k] * d[k];
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i)
#pragma GCC unroll 3
      for (int p = i / 2; p < 3; ++p) s.row[i].pair[p] += scaled.pair[p] * DoublePair{m.row[k][i], m.row[k][i]};
  }
}

/// M x, M in full.
inline SpatialVector multiply(const SpatialMatrix& m, const SpatialVector& x) {
  SpatialVector out;
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) out.set(i, dot(m.row[i], x));
  return out;
}

/// M^T x, M in full.
inline SpatialVector multiplyTransposed(const SpatialMatrix& m, const SpatialVector& x) {
  SpatialVector out = m.row[0] * x[0];
#pragma GCC unroll 6
  for (int i = 1; i < 6; ++i) out.addScaled(m.row[i], x[i]);
  return out;
}

/// The factors L D L^T of a symmetric positive semidefinite matrix, L with a unit diagonal.
struct SpatialLdlt {
  SpatialVector lower[6];  ///< column k of L below its diagonal; zero on and above it
  SpatialVector inverseD;  ///< 1 / D; 0 for a pivot that is rounding, so that nothing moves or pushes in its direction

  /// Factorises the symmetric matrix M, which is overwritten.
  void factorize(SpatialMatrix& m) {
    // A pivot below this fraction of its diagonal element is rounding: the direction is redundant.
    constexpr double kRounding = 1e-14;
    SpatialVector least;
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) least.set(k, kRounding * m.row[k][k]);
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) {
      const double pivot = m.row[k][k];
      const double reciprocal = pivot > least[k] ? 1 / pivot : 0;
      inverseD.set(k, reciprocal);
      // L_ik = M_ik / D_k for i > k, taken from row k because M is symmetric.
      SpatialVector column = m.row[k] * reciprocal;
#pragma GCC unroll 6
      for (int i = 0; i <= k; ++i) column.set(i, 0);
      lower[k] = column;
      // M_ij -= L_ik D_k L_jk in the upper triangle that remains.
#pragma GCC unroll 6
      for (int i = k + 1; i < 6; ++i) {
        const double s = m.row[k][i];
#pragma GCC unroll 3
        for (int p = i / 2; p < 3; ++p) m.row[i].pair[p] -= column.pair[p] * DoublePair{s, s};
      }
    }
  }

  /// x := L^-1 x.
  void solveLower(SpatialVector& x) const {
#pragma GCC unroll 6
    for (int k = 0; k < 5; ++k) x.subtractScaled(lower[k], x[k]);
  }
  /// M := L^-1 M, M in full.
  void solveLower(SpatialMatrix& m) const {
#pragma GCC unroll 6
    for (int k = 0; k < 5; ++k)
#pragma GCC unroll 6
      for (int i = k + 1; i < 6; ++i) m.row[i].subtractScaled(m.row[k], lower[k][i]);
  }
  /// x := L^-T x.
  void solveLowerTransposed(SpatialVector& x) const {
#pragma GCC unroll 6
    for (int k = 4; k >= 0; --k) x.set(k, x[k] - dot(lower[k], x));
  }
};

}  // namespace spark::articulated
