#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(lift 0.2)`: sets the speed of the slider above it [m/s], at once and until the next command, with the force of its
/// motor.
class SliderEffector : public Effector {
  SPARK_CLASS(SliderEffector, Effector)
 public:
  static void describe(Description<SliderEffector>& d) {
    d.doc("Drives the slider joint above it: (name speed) in m/s, clamped to the joint's maximum speed.");
    d.link(&SliderEffector::joint_, JointAbove<engine::JointType::slider>("SliderJoint")).required(kNoJointAbove);
  }
  std::string act(const Element& action) override {
    IJoint* const joint = joint_.get();
    if (!joint) return "expected a SliderJoint above it, found none";
    NumberArguments read(action);
    double speed = 0;
    if (read(0, speed)) joint->drive(0, clampSpeed(*joint, 0, speed));
    return read.remark();
  }

 private:
  Link<IJoint> joint_;
};

}  // namespace spark
