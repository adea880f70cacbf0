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

/// To the nearest angular motor above.
inline Route<IJoint> AngularMotorAbove() { return JointAbove<engine::JointType::angularMotor>("AngularMotor"); }

inline constexpr const char* kNoJointAbove = "It does nothing. Put it below the joint it belongs to.";

}  // namespace spark
