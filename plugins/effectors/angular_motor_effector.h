#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(he1 1.5)`: sets the speed of the angular motor above it [rad/s], at once and until the next command;
/// `(shoulder 1 0 -2)` those of all its axes. A motor that is disabled (too hot, without energy) gets speed 0 instead.
class AngularMotorEffector : public Effector {
  SPARK_CLASS(AngularMotorEffector, Effector)
 public:
  static void describe(Description<AngularMotorEffector>& d) {
    d.doc(
        "Drives the angular motor above it: (name speed) in rad/s, with a speed for each further axis, clamped to the "
        "maximum speeds of the motor and of the hinge above it. A disabled motor stops.");
    d.link(&AngularMotorEffector::motor_, AngularMotorAbove()).required(kNoJointAbove);
    d.link(&AngularMotorEffector::hinge_, AngularMotorAbove().above<IJoint>());
    d.link(&AngularMotorEffector::device_, Above<IMotor>());
  }
  std::string act(const Element& action) override {
    IJoint* const motor = motor_.get();
    if (!motor) return "expected an AngularMotor above it, found none";
    NumberArguments read(action);
    const bool disabled = device_ && device_->disabled();
    // The first axis needs a speed; the others keep theirs without one.
    const auto isDriven = [&](int axis) {
      return axis < motor->axes() && !motor->axisNow(axis).isZero(0) && action.at(static_cast<std::size_t>(axis) + 1);
    };
    for (int axis = 0; axis == 0 || isDriven(axis); ++axis) {
      double speed = 0;
      if (!read(static_cast<std::size_t>(axis), speed)) break;
      speed = clampSpeed(*motor, axis, disabled ? 0 : speed);
      motor->drive(axis, hinge_ && axis == 0 ? clampSpeed(*hinge_, 0, speed) : speed);
    }
    return read.remark();
  }

 private:
  Link<IJoint> motor_, hinge_;
  Link<IMotor> device_;  ///< the motor's model; empty for motors without one
};

}  // namespace spark
