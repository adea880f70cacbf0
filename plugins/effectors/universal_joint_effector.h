#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(lae1_2 0.5 -0.5)`: sets the speeds of both axes of the universal joint above it [rad/s], at once and until the
/// next command.
class UniversalJointEffector : public Effector {
  SPARK_CLASS(UniversalJointEffector, Effector)
 public:
  static void describe(Description<UniversalJointEffector>& d) {
    d.doc("Drives the universal joint above it: (name speed1 speed2) in rad/s, clamped to the joint's maximum speeds.");
    d.link(&UniversalJointEffector::joint_, JointAbove<engine::JointType::universal>("UniversalJoint"))
        .required(kNoJointAbove);
  }
  std::string act(const Element& action) override {
    IJoint* const joint = joint_.get();
    if (!joint) return "expected a UniversalJoint above it, found none";
    NumberArguments read(action);
    double speed[2] = {0, 0};
    if (!read(0, speed[0]) || !read(1, speed[1])) return read.remark();
    for (int axis = 0; axis < 2; ++axis) joint->drive(axis, clampSpeed(*joint, axis, speed[axis]));
    return read.remark();
  }

 private:
  Link<IJoint> joint_;
};

}  // namespace spark
