#pragma once
/// \file
/// Directions, points and rotations between the frame of a joint's body and the world frame; nullptr: the world.

#include "api/state.h"
#include "rotations.h"

namespace spark::physics {

inline Vec3 toWorld(const engine::DynamicState* b, const Vec3& direction) {
  return b ? Vec3(b->rotation * direction) : direction;
}
inline Vec3 toBody(const engine::DynamicState* b, const Vec3& direction) {
  return b ? Vec3(b->rotation.transpose() * direction) : direction;
}
inline Vec3 pointToWorld(const engine::DynamicState* b, const Vec3& p) {
  return b ? Vec3(toWorld(b, p) + b->position) : p;
}
inline Vec3 pointToBody(const engine::DynamicState* b, const Vec3& p) { return b ? toBody(b, p - b->position) : p; }
inline Vec3 angularVelocity(const engine::DynamicState* b) { return b ? b->angularVelocity : Vec3(Vec3::Zero()); }

/// The rotation `q`, given relative to the world, relative to a body.
inline Quaternion relativeTo(const engine::DynamicState* b, const Quaternion& q) {
  return b ? conjugateTimes(b->quaternion, q) : q;
}

/// The rotation of the second body relative to the first.
inline Quaternion relativeRotation(const engine::DynamicState* a, const engine::DynamicState* b) {
  return relativeTo(a, b ? b->quaternion : Quaternion{1, 0, 0, 0});
}

/// The angle of a hinge within one turn, with its rotation and axis in the frame of the first body [rad].
inline double hingeAngleOf(const engine::DynamicState& a, const engine::DynamicState* b, const Quaternion& rotation,
                           const Vec3& axis) {
  return hingeAngle(b ? timesConjugate(conjugateTimes(a.quaternion, b->quaternion), rotation)
                      : conjugateTimesConjugate(a.quaternion, rotation),
                    axis);
}

/// The coordinate of an axis from its angle within one turn, with the sign by which it is seen [rad].
inline double viewed(double sign, double angle, std::int32_t turns) {
  return sign * (turns == 0 ? angle : angle + 2 * kPi * turns);
}

inline bool attached(const engine::Joint& j) { return j.a != engine::kNone; }

}  // namespace spark::physics
