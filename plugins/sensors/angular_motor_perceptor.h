#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(HJ (n hj1) (ax 1.72) (rt 0.00) (tq 0.00) (tp 23.00) (ct 0.00))`, each item as switched on: angle [deg] and rate
/// [deg/s] of the hinge that the motor above it drives, the motor's torque [Nm], temperature [deg C] (when it changed
/// by more than one) and current [mA].
class AngularMotorPerceptor : public Perceptor {
  SPARK_CLASS(AngularMotorPerceptor, Perceptor)
 public:
  static void describe(Description<AngularMotorPerceptor>& d) {
    using P = AngularMotorPerceptor;
    d.doc(
        "Senses the angular motor above it: (HJ (n name) (ax deg) (rt deg/s) (tq Nm) (tp C) (ct mA)), as switched on.");
    d.link(&P::motor_, AngularMotorAbove()).required(kNoJointAbove);
    d.link(&P::hinge_, AngularMotorAbove().above<IJoint>());
    d.link(&P::device_, Above<IMotor>());
    d.property("senseAngle", &P::senseAngle_).doc("Says the hinge's angle.");
    d.property("senseRate", &P::senseRate_).doc("Says the hinge's speed.");
    d.property("senseTorque", &P::senseTorque_).doc("Says the motor's torque; the motor must have feedback enabled.");
    d.property("senseCurrent", &P::senseCurrent_).doc("Says the motor's current where the motor models one.");
    d.property("senseTemperature", &P::senseTemperature_)
        .doc("Says the motor's temperature after each change above 1 C, where the motor models one.");
    d.property("toldTemperature", &P::toldTemperature_).unit("C").state().doc("The temperature that was said last.");
  }
  void sense(Predicates& out, const Event&) override {
    const IJoint* const motor = motor_.get();
    if (!motor) return;
    const IJoint& angles = hinge_ ? *hinge_ : *motor;
    const IMotor* const device = device_.get();
    out.open("HJ").pair("n", name());
    if (senseAngle_) out.pair("ax", radToDeg(angles.angle(0)));
    if (senseRate_) out.pair("rt", radToDeg(angles.angleRate(0)));
    if (senseTorque_) out.pair("tq", motor->feedbackTorque());
    if (senseTemperature_ && device) {
      const double now = device->temperature();
      if (std::abs(now - toldTemperature_) > 1) out.pair("tp", toldTemperature_ = now);
    }
    if (senseCurrent_ && device) out.pair("ct", 1000 * device->current());
    out.close();
  }

 private:
  Link<IJoint> motor_, hinge_;
  Link<IMotor> device_;  ///< of motors that are modelled
  double toldTemperature_ = -1000;
  bool senseAngle_ = true, senseRate_ = false, senseTorque_ = false, senseCurrent_ = false, senseTemperature_ = false;
};

}  // namespace spark
