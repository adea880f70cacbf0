#pragma once
/// \file
/// The joint that a sensor below a joint reads.

#include "api/agents.h"
#include "api/physics.h"

namespace spark {

/// The nearest joint of that type above `sensor`; nullptr, with a line in the log, when there is none.
inline IJoint* jointAbove(const SceneNode& sensor, engine::JointType type, const char* typeName) {
  for (Leaf* up = sensor.parent(); up; up = up->parent())
    if (auto* joint = up->as<IJoint>(); joint && joint->jointType() == type) return joint;
  sensor.kernel().log().warning("{}: expected a {} above it, found none; it senses nothing. Put it below the joint it is to read.", sensor.path(), typeName);
  return nullptr;
}

}  // namespace spark
