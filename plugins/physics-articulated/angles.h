#pragma once
/// \file
/// Rotations and angles of joints. Nothing here calls the mathematical library, whose last digits depend on the
/// processor.

#include <Eigen/Geometry>
#include <array>

#include "api/math.h"

namespace spark::articulated {

/// A rotation, w x y z.
struct Turn {
  double w = 1;
  Vec3 v = Vec3::Zero();
  static Turn of(const double* q) { return {q[0], {q[1], q[2], q[3]}}; }
  static Turn of(const std::array<double, 4>& q) { return of(q.data()); }
  /// Of a rotation matrix; the sign is one of two.
  static Turn of(const Mat3& m);
  Turn inverse() const { return {w, -v}; }
};
inline Turn operator*(const Turn& a, const Turn& b) {
  return {a.w * b.w - a.v.dot(b.v), a.w * b.v + b.w * a.v + a.v.cross(b.v)};
}

/// As std::atan2, within a few of the last digit, and the same on every processor.
double angleOf(double y, double x);

/// How far a joint has turned about `axis` from where it was set, -pi..pi: `turn` is the second body's rotation in the
/// first, relative to what it was.
double hingeAngle(const Turn& turn, const Vec3& axis);

/// Two directions that stand upright on `n` and on each other.
void planeSpace(const Vec3& n, Vec3& p, Vec3& q);

/// The cross whose arms are `x`, what of `y` stands upright on it, and the third direction.
Mat3 crossOf(const Vec3& x, const Vec3& y);

}  // namespace spark::articulated
