#pragma once
/// \file
/// Quaternions, joint angles and frames of vectors. Only the square root is taken from the mathematical library: its
/// result is exact, while the last digits of other functions depend on the library and the processor.

#include <Eigen/Geometry>
#include <array>

#include "api/math.h"

namespace spark::articulated {

/// A rotation as a unit quaternion w + v.
struct Quaternion {
  double w = 1;
  Vec3 v = Vec3::Zero();
  /// From 4 elements, w x y z.
  static Quaternion of(const double* q) { return {q[0], {q[1], q[2], q[3]}}; }
  static Quaternion of(const std::array<double, 4>& q) { return of(q.data()); }
  /// From a rotation matrix; the sign is arbitrary.
  static Quaternion of(const Mat3& m);
  /// The inverse rotation.
  Quaternion conjugate() const { return {w, -v}; }
};
/// The Hamilton product: rotation b, then a.
inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.v.dot(b.v), a.w * b.v + b.w * a.v + a.v.cross(b.v)};
}

/// std::atan2 [rad, -pi..pi] to within a few units in the last place, with the same digits on every processor.
double portableAtan2(double y, double x);

/// The angle [rad, -pi..pi] of body a relative to b about `axis` (length 1, in a). `rotation` is b's rotation relative
/// to a, as a change since the joint was set.
double hingeAngle(const Quaternion& rotation, const Vec3& axis);

/// Two unit vectors p and q perpendicular to n (length 1) and to each other, with p x q = n: the friction directions
/// that ODE takes (dPlaneSpace).
void perpendicularBasis(const Vec3& n, Vec3& p, Vec3& q);

/// The right-handed frame whose first axis is along x and whose second is along the part of y that is perpendicular to
/// x, as columns. x and y must not be parallel.
Mat3 orthonormalFrame(const Vec3& x, const Vec3& y);

}  // namespace spark::articulated
