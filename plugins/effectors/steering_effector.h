#pragma once

#include "api/joint_command.h"
#include "api/phases.h"

namespace spark {

/// `(lf 20)`: turns the first axis (steering) of the hinge2 above it to an angle, from now on until the next command,
/// with the force of its motor.
class SteeringEffector : public Effector {
  SPARK_CLASS(SteeringEffector, Effector)
 public:
  static void describe(Description<SteeringEffector>& d) {
    using E = SteeringEffector;
    d.doc("Steers the wheel of the hinge2 joint above it: (name angle) in deg, as a Hinge2Perceptor senses it.");
    d.link(&E::joint_, JointAbove<engine::JointType::hinge2>("Hinge2Joint")).required(kNoJointAbove);
    d.property("angle", &E::angleDeg_).unit("deg").state().doc("The last command.");
    d.property("mostAngle", &E::mostDeg_).unit("deg").range(0, 180).doc("Largest angle to either side.");
    d.property("rate", &E::rate_).unit("1/s").min(0).doc("Speed of turning for each angle that is left.");
    d.property("mostSpeed", &E::mostSpeedDeg_).unit("deg/s").min(0).doc("Largest speed of turning.");
    d.on<&E::turn>(phase::kPrepare);
  }
  std::string act(const Element& action) override {
    if (!joint_) return "expected a Hinge2Joint above it, found none";
    NumberArguments read(action);
    double angle = 0;
    if (read(0, angle)) angleDeg_ = std::clamp(angle, -mostDeg_, mostDeg_);
    return read.remark();
  }

 private:
  void turn(const Event&) {
    IJoint* const joint = joint_.get();
    if (!joint) return;
    const double left = degToRad(angleDeg_) - joint->angle(0), most = degToRad(mostSpeedDeg_);
    const double speed = std::clamp(rate_ * left, -most, most);
    // A speed wakes what sleeps; what is there needs none.
    constexpr double kNothing = 1e-4;  // rad/s
    if (std::abs(speed) > kNothing || std::abs(joint->angleRate(0)) > kNothing) joint->drive(0, speed);
  }
  Link<IJoint> joint_;
  double angleDeg_ = 0, mostDeg_ = 40, rate_ = 10, mostSpeedDeg_ = 180;
};

}  // namespace spark
