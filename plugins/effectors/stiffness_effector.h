#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(he1s 0.8)`: sets the fraction of its maximum torque that the angular motor above it may use, 0..1, at once and
/// until the next command.
class StiffnessEffector : public Effector {
  SPARK_CLASS(StiffnessEffector, Effector)
 public:
  static void describe(Description<StiffnessEffector>& d) {
    d.doc("Sets the stiffness of the angular motor above it: (name fraction), 0..1.");
    d.link(&StiffnessEffector::motor_, Above<IMotor>()).required("It does nothing. Put it below an AngularMotor.");
    d.property("stiffness", &StiffnessEffector::stiffness_).range(0, 1).state().doc("The last command.");
  }
  std::string act(const Element& action) override {
    NumberArguments read(action);
    double stiffness = 0;
    if (!read(0, stiffness)) return read.remark();
    stiffness_ = std::clamp(stiffness, 0.0, 1.0);
    if (!motor_) return "expected an AngularMotor above it, found none";
    motor_->setStiffness(stiffness_);
    if (stiffness_ != stiffness)
      return fmt::format("expected a stiffness of 0 to 1, found {}, which counts as {}", stiffness, stiffness_);
    return read.remark();
  }

 private:
  Link<IMotor> motor_;
  double stiffness_ = 1;
};

}  // namespace spark
