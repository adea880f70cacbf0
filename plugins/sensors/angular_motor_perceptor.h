#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(HJ (n hj1) (ax 1.72) (rt 0.00) (tq 0.00) (tp 23.00) (ct 0.00))`, each item if it is switched on: angle [deg] and
/// rate [deg/s] of the hinge that the motor above it drives; the motor's torque [Nm], its temperature [deg C] (only
/// after a change by more than one degree) and its current [mA].
class AngularMotorPerceptor : public Perceptor {
  SPARK_CLASS(AngularMotorPerceptor, Perceptor)
 public:
  static void describe(Description<AngularMotorPerceptor>& d) {
    using P = AngularMotorPerceptor;
    d.doc(
        "Senses the angular motor above it: (HJ (n name) (ax deg) (rt deg/s) (tq Nm) (tp C) (ct mA)), each "
        "item if it is switched on.");
    d.link(&P::motor_, AngularMotorAbove()).required(kNoJointAbove);
    d.link(&P::hinge_, AngularMotorAbove().above<IJoint>());
    d.link(&P::device_, Above<IMotor>());
    d.property("senseAngle", &P::senseAngle_).doc("Reports the hinge's angle.");
    d.property("senseRate", &P::senseRate_).doc("Reports the hinge's angular velocity.");
    d.property("senseTorque", &P::senseTorque_).doc("Reports the motor's torque; needs feedback enabled at the motor.");
    d.property("senseCurrent", &P::senseCurrent_).doc("Reports the current of a modelled motor.");
    d.property("senseTemperature", &P::senseTemperature_)
        .doc("Reports the temperature of a modelled motor after each change by more than 1 C.");
    d.property("toldTemperature", &P::reportedTemperature_).unit("C").state().doc("The last reported temperature.");
  }
  void sense(Predicates& out, const Event&) override {
    const IJoint* const motor = motor_.get();
    if (!motor) return;
    const IJoint& angles = hinge_ ? *hinge_ : *motor;  // a motor below a hinge has the hinge's angle
    const IMotor* const device = device_.get();
    out.open("HJ").pair("n", messageName());
    if (senseAngle_) out.pair("ax", radToDeg(angles.sensedAngle(0)));
    if (senseRate_) out.pair("rt", radToDeg(angles.angleRate(0)));
    if (senseTorque_) out.pair("tq", motor->feedbackTorque());
    if (senseTemperature_ && device) {
      const double now = device->temperature();
      if (std::abs(now - reportedTemperature_) > 1) out.pair("tp", reportedTemperature_ = now);
    }
    if (senseCurrent_ && device) out.pair("ct", 1000 * device->current());
    out.close();
  }

 private:
  Link<IJoint> motor_, hinge_;
  Link<IMotor> device_;                 ///< the motor's model; empty for motors without one
  double reportedTemperature_ = -1000;  ///< deg C
  bool senseAngle_ = true, senseRate_ = false, senseTorque_ = false, senseCurrent_ = false, senseTemperature_ = false;
};

}  // namespace spark
