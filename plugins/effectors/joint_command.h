#pragma once
/// \file
/// What effectors of joints share: finding the joint, reading speeds from a message, writing them to the motor.

#include <algorithm>
#include <cmath>
#include <string>

#include "api/agents.h"
#include "api/physics.h"

namespace spark {

/// The nearest joint of that type above `effector`; nullptr, with a line in the log, when there is none.
inline IJoint* jointAbove(const SceneNode& effector, engine::JointType type, const char* typeName) {
  for (Leaf* up = effector.parent(); up; up = up->parent())
    if (auto* joint = up->as<IJoint>(); joint && joint->jointType() == type) return joint;
  effector.kernel().log().warning("{}: expected a {} above it, found none; it drives nothing. Put it below the joint it is to drive.", effector.path(), typeName);
  return nullptr;
}

/// Argument `index` (from 0) of `(predicate arguments...)` as a finite number. Returns "" or what is wrong; `out` is then untouched.
inline std::string readNumber(const Element& action, std::size_t index, double& out) {
  const Element argument = action.at(index + 1);
  if (!argument || argument.isList())
    return fmt::format("expected a number as argument {}, found {}", index + 1, argument ? "a list" : "none");
  const double v = argument.number();
  if (!std::isfinite(v)) return fmt::format("expected a finite number as argument {}, found {}", index + 1, v);
  out = v;
  return {};
}

/// `speed` within the joint's greatest (which is 0 when unlimited) [rad/s].
inline double clampSpeed(const IJoint& joint, int axis, double speed) {
  const double most = joint.maxSpeed(axis);
  return most > 0 ? std::clamp(speed, -most, most) : speed;
}

}  // namespace spark
