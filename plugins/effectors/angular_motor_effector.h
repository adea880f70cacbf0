#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(he1 1.5)`: sets the speed of the angular motor above it [rad/s], at once and until the next command. A motor that
/// is disabled (too hot, without energy) gets speed 0 instead.
class AngularMotorEffector : public Effector {
  SPARK_CLASS(AngularMotorEffector, Effector)
 public:
  static void describe(Description<AngularMotorEffector>& d) {
    d.doc(
        "Drives the angular motor above it: (name speed) in rad/s, clamped to the maximum speeds of the motor and "
        "of the hinge above it. A disabled motor stops.");
    d.link(&AngularMotorEffector::motor_, AngularMotorAbove()).required(kNoJointAbove);
    d.link(&AngularMotorEffector::hinge_, AngularMotorAbove().above<IJoint>());
    d.link(&AngularMotorEffector::device_, Above<IMotor>());
  }
  std::string act(const Element& action) override {
    IJoint* const motor = motor_.get();
    if (!motor) return "expected an AngularMotor above it, found none";
    NumberArguments read(action);
    double speed = 0;
    if (!read(0, speed)) return read.remark();
    if (device_ && device_->disabled()) {
      motor->drive(0, 0);
      return read.remark();
    }
    speed = clampSpeed(*motor, 0, speed);
    motor->drive(0, hinge_ ? clampSpeed(*hinge_, 0, speed) : speed);
    return read.remark();
  }

 private:
  Link<IJoint> motor_, hinge_;
  Link<IMotor> device_;  ///< the motor's model; empty for motors without one
};

}  // namespace spark
