#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(he1 1.5)`: speed of the angular motor above it, rad/s, at once and until the next command. A motor that is
/// disabled (too hot, without energy) stands still instead.
class AngularMotorEffector : public Effector {
  SPARK_CLASS(AngularMotorEffector, Effector)
 public:
  static void describe(Description<AngularMotorEffector>& d) {
    d.doc(
        "Drives the angular motor above it: (name speed) in rad/s, within the greatest speed of the motor or of the "
        "hinge that holds it; a "
        "disabled motor stands still.");
  }
  std::string act(const Element& action) override {
    if (!motor_) return "there is no AngularMotor above it";
    NumberArguments read(action);
    double speed = 0;
    if (!read(0, speed)) return read.remark();
    if (device_ && device_->disabled()) {
      motor_->drive(0, 0);
      return read.remark();
    }
    speed = clampSpeed(*motor_, 0, speed);
    motor_->drive(0, hinge_ ? clampSpeed(*hinge_, 0, speed) : speed);
    return read.remark();
  }

 protected:
  void onLink() override {
    Effector::onLink();
    lookUp();
  }
  void onMoved() override {
    Effector::onMoved();
    lookUp();
  }

 private:
  void lookUp() {
    motor_ = jointAbove(*this, engine::JointType::angularMotor, "AngularMotor");
    hinge_ = motor_ ? motor_->leaf().ancestor<IJoint>() : nullptr;
    device_ = motor_ ? motor_->leaf().as<IMotor>() : nullptr;
  }
  IJoint* motor_ = nullptr;
  IJoint* hinge_ = nullptr;
  const IMotor* device_ = nullptr;  ///< of motors that are modelled
};

}  // namespace spark
