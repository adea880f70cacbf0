#pragma once
/// \file
/// Rotations with the digits of ODE 0.16, which recorded sessions of the installed base repeat: each function computes
/// in that library's order of operations. A test compares them with the library bit for bit.

#include <array>

#include "api/math.h"

namespace spark::physics {

/// w x y z.
using Quaternion = std::array<double, 4>;

/// The rotation matrix `m` made orthonormal, as ODE stores the rotation of a body: the first row is normalised, the
/// third is perpendicular to the other two. The second is only corrected where it is perpendicular to the first one
/// already; rotations in single precision keep it.
Mat3 orthogonalized(const Mat3& m);
/// The quaternion of a rotation matrix, of length 1 as far as the matrix is orthonormal.
Quaternion quaternionOf(const Mat3& m);
/// `q` divided by its length.
Quaternion normalized(const Quaternion& q);

// Products of quaternions, with conjugates: conj(a) * b, a * conj(b), conj(a) * conj(b).
Quaternion conjugateTimes(const Quaternion& a, const Quaternion& b);
Quaternion timesConjugate(const Quaternion& a, const Quaternion& b);
Quaternion conjugateTimesConjugate(const Quaternion& a, const Quaternion& b);

/// The frame whose first axis is along `x` and whose second is along the part of `y` that is perpendicular to `x`, as
/// columns. Zero when they are parallel.
Mat3 frameFromAxes(const Vec3& x, const Vec3& y);

/// The angle [rad, -pi..pi] of a hinge whose second body has the rotation `relative` to the first, about `axis` in the
/// first.
double hingeAngle(const Quaternion& relative, const Vec3& axis);

/// m * v and m^T * v, summed from left to right.
Vec3 times(const Mat3& m, const Vec3& v);
Vec3 transposeTimes(const Mat3& m, const Vec3& v);
/// a . b, summed from left to right.
inline double dot(const Vec3& a, const Vec3& b) { return a.x() * b.x() + a.y() * b.y() + a.z() * b.z(); }

}  // namespace spark::physics
