#pragma once

#include "api/joint_command.h"
#include "api/robot_parts.h"

namespace spark {

/// `(he1 1.5)`: sets the speed of the hinge above it [rad/s], at once and until the next command.
class HingeEffector : public Effector, public IFreezable {
  SPARK_CLASS(HingeEffector, Effector)
 public:
  static void describe(Description<HingeEffector>& d) {
    d.doc("Drives the hinge joint above it: (name speed) in rad/s, clamped to the joint's maximum speed.");
    d.link(&HingeEffector::joint_, JointAbove<engine::JointType::hinge>("HingeJoint")).required(kNoJointAbove);
    d.implements<IFreezable>();
    d.property("frozen", &HingeEffector::frozen_)
        .state()
        .doc("Commands set speed 0: the rule about self-collisions has frozen the effector.");
    d.property("ignoreCommandAtStop", &HingeEffector::ignoreCommandAtStop_)
        .doc("At or beyond a stop commands are ignored and the speed is unchanged, as in the installed base.");
  }
  std::string act(const Element& action) override {
    IJoint* const joint = joint_.get();
    if (!joint) return "expected a HingeJoint above it, found none";
    NumberArguments read(action);
    double speed = 0;
    if (read(0, speed)) {
      const bool ignored = ignoreCommandAtStop_ && joint->atStop(0);
      if (!ignored) joint->drive(0, frozen_ ? 0 : clampSpeed(*joint, 0, speed));
      // As in the installed base, a command wakes the body even if it does not reach the motor.
      if (speed != 0 && (ignored || frozen_)) wakeFirstBody();
    }
    return read.remark();
  }
  Leaf& leaf() override { return *this; }
  void freeze(bool on) override { frozen_ = on; }

 private:
  void wakeFirstBody() {
    if (IRigidBody* body = joint_->body(0); body && !body->enabled()) body->enable();
  }
  Link<IJoint> joint_;
  bool ignoreCommandAtStop_ = true, frozen_ = false;
};

}  // namespace spark
