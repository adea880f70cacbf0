#include "angular_motor.h"

#include <cmath>

#include "api/phases.h"
#include "physics_server.h"
#include "spark/state.h"

namespace spark {

void AngularMotor::describe(Description<AngularMotor>& d) {
  using M = AngularMotor;
  d.doc(
      "Drives the angles between two bodies; below a HingeJoint it drives the hinge's. With a maxTorque it is a "
      "modelled motor: current, "
      "heat and battery follow from its torque, and limit it.");
  d.implements<IMotor>();
  d.link(&M::hinge_, Above<HingeJoint>());
  d.link(&M::battery_, At<Battery>(&M::batteryPath_));
  d.link(&M::server_, At<PhysicsServer>());
  d.property("numAxes", &M::numAxes, &M::setNumAxes).range(0, 3).doc("How many axes it drives.");
  d.method("setMotorAxis", &M::setMotorAxis)
      .parameters({"axis", "0 world, 1 first body, 2 second body", "direction"})
      .doc("An axis, its direction given in the world, and what it turns with.");
  d.method("setUserMode", &M::setUserMode).doc("Axes and angles are as set.");
  d.method("setEulerMode", &M::setEulerMode).doc("Three Euler angles, computed.");
  d.method("getMode", &M::mode).doc("user or euler.");
  d.method("setAxisAngle", &M::setAxisAngle)
      .parameters({"axis", "angle [deg]"})
      .doc("The angle about an axis, which user mode cannot measure.");
  d.method("getAxisAngle", &M::axisAngle)
      .parameters({"axis"})
      .doc("The angle about an axis; below a hinge, the hinge's [deg].");
  d.method("getAxisAngleRate", &M::axisAngleRate).parameters({"axis"}).doc("Its rate [deg/s].");
  d.method("getAxisAnchor", &M::axisAnchor)
      .parameters({"axis"})
      .doc("What an axis turns with: 0 world, 1 first body, 2 second body.");

  d.property("battery", &M::batteryPath, &M::setBatteryPath)
      .doc("Path of the Battery it draws from, relative to the motor.");
  d.property("speedConstant", &M::speedConstant_).unit("V s/rad").doc("Back electromotive force per speed.");
  d.property("torqueConstant", &M::torqueConstant_).unit("Nm/A").doc("Torque per current.");
  d.property("resistance", &M::resistance_).unit("Ohm").min(0).doc("Resistance of the winding.");
  d.property("environmentTempeature", &M::environment_)
      .unit("C")
      .doc("Temperature around it (the scene files' own spelling).");
  d.property("thermalConductivity", &M::conductivity_).unit("W/K").min(0).doc("Heat it gives away per degree.");
  d.property("heatCapacity", &M::heatCapacity_).unit("J/K").min(0).doc("Heat it takes per degree.");
  d.property("protectionTempeature", &M::protectionTemperature_)
      .unit("C")
      .doc("Above it the motor protects itself (the scene files' own spelling).");
  d.property("protectionStiffness", &M::protectionStiffness_)
      .range(0, 1)
      .doc("Greatest stiffness of a motor that protects itself.");
  d.property("maxTorque", &M::maxTorque_)
      .unit("Nm")
      .min(0)
      .doc("Torque at stiffness 1; 0: no model, the force is what setMaxMotorForce says.");
  d.property("stiffness", &M::stiffness_).range(0, 1).state().doc("Part of the greatest torque it may use.");
  d.property("temperature", &M::temperature_).unit("C").state().doc("Temperature of the winding.");
  d.property("current", &M::current_).unit("A").readOnly().doc("Current in the last step.");
  d.property("disabled", &M::disabled).doc("It takes no commands: its battery is empty or it is too hot.");
  d.on<&M::prepare>(phase::kPrepare);
  d.on<&M::measure>(phase::kPlace);
}

bool AngularMotor::disabled() const {
  if (maxTorque_ <= 0) return false;
  const Battery* battery = battery_.get();
  return tooHot() || (battery && battery->empty());
}

void AngularMotor::prepare(const Event&) {
  if (!modelled()) return;
  const Battery* battery = battery_.get();
  const double stiffness = battery && battery->empty() ? 0.0
                           : tooHot()                  ? std::min(stiffness_, protectionStiffness_)
                                                       : stiffness_;
  setParameter(engine::JointParameter::maxForce, 0, stiffness * maxTorque_);
}

void AngularMotor::measure(const Event& event) {
  if (!modelled()) return;
  current_ = torqueConstant_ != 0 ? feedbackTorque() / torqueConstant_ : 0;
  const double heat = current_ * current_ * resistance_;  // W
  const double speed = std::abs(hinge_ ? hinge_->angleRate(0) : angleRate(0));
  if (battery_ && server_ && server_->batteryDischarge())
    battery_->drain((speedConstant_ * speed * current_ + heat) * event.step);
  if (server_ && server_->jointHeating() && heatCapacity_ > 0)
    temperature_ += (heat - conductivity_ * (temperature_ - environment_)) * event.step / heatCapacity_;
}

void AngularMotor::saveState(StateWriter& out) const {
  Joint::saveState(out);
  out.write(current_);
}

void AngularMotor::loadState(StateReader& in) {
  Joint::loadState(in);
  current_ = in.readNumber();
}

void AngularMotor::apply() {
  if (engine()) engine()->setAngularMotor(handle(), axes_, euler_);
}

void AngularMotor::setNumAxes(int n) {
  axes_ = n;
  apply();
}

void AngularMotor::setMotorAxis(int axis, int frame, const Vec3& direction) {
  expectAxis(axis);
  if (frame < 0 || frame > 2)
    throw Error(where() + ": expected 0 (world), 1 (first body) or 2 (second body), found " + std::to_string(frame));
  anchors_[axis] = frame;
  withBodies([this, axis, frame, direction] { engine()->setAxis(handle(), axis, direction, frame); });
}

void AngularMotor::setAxisAngle(int axis, double deg) {
  expectAxis(axis);
  if (engine()) engine()->setMotorAngle(handle(), axis, degToRad(deg));
}

double AngularMotor::axisAngle(int axis) const {
  expectAxis(axis);
  const HingeJoint* hinge = hinge_.get();
  return hinge ? radToDeg(hinge->angle(0)) : angleDeg(axis);
}

double AngularMotor::axisAngleRate(int axis) const {
  expectAxis(axis);
  const HingeJoint* hinge = hinge_.get();
  return hinge ? radToDeg(hinge->angleRate(0)) : angleRateDeg(axis);
}

int AngularMotor::axisAnchor(int axis) const {
  expectAxis(axis);
  return anchors_[axis];
}

}  // namespace spark
