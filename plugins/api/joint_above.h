#pragma once
/// \file
/// The joint that a sensor reads, or an effector drives: robots of the installed base put both below their joint.

#include "api/physics.h"
#include "spark/abi/api/joint_above.h"

namespace spark {

template <engine::JointType kType>
bool isOfType(const IJoint& joint) {
  return joint.jointType() == kType;
}

/// To the nearest joint of a type above; `className` for people, e.g. "HingeJoint":
///
///     d.link(&HingePerceptor::joint_, JointAbove<engine::JointType::hinge>("HingeJoint")).required(kNoJointAbove);
template <engine::JointType kType>
Route<IJoint> JointAbove(const char* className) {
  return Above<IJoint>().where<isOfType<kType>>(className);
}

/// The nearest joint of that type above `part`; nullptr, with a line in the log, when there is none. For onLink and
/// onMoved: keep the pointer, which is valid until one of them runs again.
inline IJoint* jointAbove(const SceneNode& part, engine::JointType type, const char* typeName) {
  for (Leaf* up = part.parent(); up; up = up->parent())
    if (auto* joint = up->as<IJoint>(); joint && joint->jointType() == type) return joint;
  part.kernel().log().warning(
      "{}: expected a {} above it, found none; it does nothing. Put it below the joint it belongs to.", part.path(),
      typeName);
  return nullptr;
}

inline constexpr const char* kNoJointAbove = "It does nothing. Put it below the joint it belongs to.";

}  // namespace spark
