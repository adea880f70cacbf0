#pragma once
/// \file
/// Vectors and rotations in Bullet's types.

#include <LinearMath/btQuaternion.h>
#include <LinearMath/btTransform.h>
#include <LinearMath/btVector3.h>

#include <Eigen/Geometry>

#include "api/math.h"

namespace spark::bullet {

inline btVector3 toBullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion toBullet(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline btMatrix3x3 toBullet(const Mat3& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
inline btTransform toBullet(const Pose& p) { return btTransform(toBullet(p.rotation), toBullet(p.position)); }
inline Vec3 toVec(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Quaterniond toEigen(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// Two unit vectors that are perpendicular to `n`, of length 1, and to each other.
inline void perpendicularBasis(const Vec3& n, Vec3& p, Vec3& q) {
  int least = 0;
  n.cwiseAbs().minCoeff(&least);
  p = n.cross(Vec3::Unit(least)).normalized();
  q = n.cross(p);
}

}  // namespace spark::bullet
