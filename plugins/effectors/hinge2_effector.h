#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(wheel 90)`: sets the speed of the second axis (rolling) of the hinge2 above it, in deg/s as in the installed base,
/// without limit.
class Hinge2Effector : public Effector {
  SPARK_CLASS(Hinge2Effector, Effector)
 public:
  static void describe(Description<Hinge2Effector>& d) {
    d.doc("Drives the second axis of the hinge2 joint above it: (name speed) in deg/s.");
    d.link(&Hinge2Effector::joint_, JointAbove<engine::JointType::hinge2>("Hinge2Joint")).required(kNoJointAbove);
  }
  std::string act(const Element& action) override {
    IJoint* const joint = joint_.get();
    if (!joint) return "expected a Hinge2Joint above it, found none";
    NumberArguments read(action);
    double speedDeg = 0;
    if (read(0, speedDeg)) joint->drive(1, degToRad(speedDeg));
    return read.remark();
  }

 private:
  Link<IJoint> joint_;
};

}  // namespace spark
