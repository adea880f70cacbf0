#pragma once
/// \file
/// Routes to the joint that a sensor reads or an effector drives. In robots of the installed base both are below their
/// joint.

#include "api/physics.h"
#include "spark/abi/api/joint_above.h"

namespace spark {

/// True when `joint` is of type `kType`.
template <engine::JointType kType>
bool isOfType(const IJoint& joint) {
  return joint.jointType() == kType;
}

/// Route to the nearest joint of a type above. `className` is the class name in messages, such as "HingeJoint":
///
///     d.link(&HingePerceptor::joint_, JointAbove<engine::JointType::hinge>("HingeJoint")).required(kNoJointAbove);
template <engine::JointType kType>
Route<IJoint> JointAbove(const char* className) {
  return Above<IJoint>().where<isOfType<kType>>(className);
}

/// Route to the nearest angular motor above.
inline Route<IJoint> AngularMotorAbove() { return JointAbove<engine::JointType::angularMotor>("AngularMotor"); }

/// The hint of required routes to a joint.
inline constexpr const char* kNoJointAbove = "It does nothing. Put it below the joint it belongs to.";

}  // namespace spark
