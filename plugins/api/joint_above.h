#pragma once
/// \file
/// The joint that a sensor reads, or an effector drives: robots of the installed base put both below their joint.

#include "api/physics.h"
#include "api/scene.h"

namespace spark {

/// The nearest joint of that type above `part`; nullptr, with a line in the log, when there is none. For onLink and
/// onMoved: keep the pointer, which is valid until one of them runs again. `typeName`: the class that the line names,
/// e.g. "HingeJoint".
inline IJoint* jointAbove(const SceneNode& part, engine::JointType type, const char* typeName) {
  for (Leaf* up = part.parent(); up; up = up->parent())
    if (auto* joint = up->as<IJoint>(); joint && joint->jointType() == type) return joint;
  part.kernel().log().warning(
      "{}: expected a {} above it, found none; it does nothing. Put it below the joint it belongs to.", part.path(),
      typeName);
  return nullptr;
}

}  // namespace spark
