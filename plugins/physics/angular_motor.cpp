#include "angular_motor.h"

#include <cmath>

#include "api/phases.h"
#include "physics_server.h"
#include "spark/state.h"

namespace spark {

void AngularMotor::describe(Description<AngularMotor>& d) {
  using M = AngularMotor;
  d.doc(
      "Drives the angles between two bodies; below a HingeJoint it drives the hinge's angle. With a maxTorque it "
      "models a real motor: its torque determines current, temperature and battery, and these limit its torque.");
  d.implements<IMotor>();
  d.link(&M::hinge_, Above<HingeJoint>());
  d.link(&M::battery_, At<Battery>(&M::batteryPath_));
  d.link(&M::server_, At<PhysicsServer>());
  d.property("numAxes", &M::numAxes, &M::setNumAxes).range(0, 3).doc("Number of axes that it drives.");
  d.method("setMotorAxis", &M::setMotorAxis)
      .parameters({"axis", "0 world, 1 first body, 2 second body", "direction"})
      .doc("Sets an axis: its direction in the world, and the frame that it is fixed to.");
  d.method("setUserMode", &M::setUserMode).doc("Axes and angles are set by the user.");
  d.method("setEulerMode", &M::setEulerMode).doc("The engine computes three Euler angles.");
  d.method("getMode", &M::mode).doc("user or euler.");
  d.method("setAxisAngle", &M::setAxisAngle)
      .parameters({"axis", "angle [deg]"})
      .doc("Sets the current angle about an axis. Needed in user mode, where the engine cannot measure it.");
  d.method("getAxisAngle", &M::axisAngle)
      .parameters({"axis"})
      .doc("Angle about an axis [deg]; below a hinge that of the hinge.");
  d.method("getAxisAngleRate", &M::axisAngleRate).parameters({"axis"}).doc("Its rate [deg/s].");
  d.method("getAxisAnchor", &M::axisAnchor)
      .parameters({"axis"})
      .doc("The frame that an axis is fixed to: 0 world, 1 first body, 2 second body.");

  d.property("battery", &M::batteryPath, &M::setBatteryPath)
      .doc("Path of the Battery that it draws from, relative to the motor.");
  d.property("speedConstant", &M::speedConstant_).unit("V s/rad").doc("Back electromotive force per speed.");
  d.property("torqueConstant", &M::torqueConstant_).unit("Nm/A").doc("Torque per current.");
  d.property("resistance", &M::resistance_).unit("Ohm").min(0).doc("Resistance of the winding.");
  d.property("environmentTempeature", &M::environment_)
      .unit("C")
      .doc("Ambient temperature. The name is spelled as in scene files.");
  d.property("thermalConductivity", &M::conductivity_)
      .unit("W/K")
      .min(0)
      .doc("Heat flow to the environment per degree of difference.");
  d.property("heatCapacity", &M::heatCapacity_).unit("J/K").min(0).doc("Heat capacity of the winding.");
  d.property("protectionTempeature", &M::protectionTemperature_)
      .unit("C")
      .doc("Temperature above which protectionStiffness applies. The name is spelled as in scene files.");
  d.property("protectionStiffness", &M::protectionStiffness_)
      .range(0, 1)
      .doc("Maximum stiffness above protectionTempeature.");
  d.property("maxTorque", &M::maxTorque_)
      .unit("Nm")
      .min(0)
      .doc("Maximum torque at stiffness 1; 0: no motor model, setMaxMotorForce sets the maximum.");
  d.property("stiffness", &M::stiffness_)
      .range(0, 1)
      .state()
      .doc("Fraction of the maximum torque that the motor may use.");
  d.property("temperature", &M::temperature_).unit("C").state().doc("Temperature of the winding.");
  d.property("current", &M::current_).unit("A").readOnly().doc("Current in the last step.");
  d.property("disabled", &M::disabled)
      .doc("True when the motor accepts no commands: its battery is empty or it is too hot.");
  d.on<&M::prepare>(phase::kPrepare);
  d.on<&M::measure>(phase::kPlace);
}

bool AngularMotor::disabled() const {
  if (maxTorque_ <= 0) return false;
  const Battery* battery = battery_.get();
  return tooHot() || (battery && battery->empty());
}

std::vector<SceneCall> AngularMotor::sceneCalls() const {
  std::vector<SceneCall> calls{{"setNumAxes", {axes_}}};
  if (euler_) calls.push_back({"setEulerMode", {}});
  for (SceneCall& call : Joint::sceneCalls()) calls.push_back(std::move(call));
  for (int axis = 0; axis < axes_; ++axis) {
    const Vec3 v = axisNow(axis);
    calls.push_back({"setMotorAxis", {axis, frames_[axis], v.x(), v.y(), v.z()}});
    if (!euler_ && angle(axis) != 0) calls.push_back({"setAxisAngle", {axis, angleDeg(axis)}});
  }
  return calls;
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
  const double heat = current_ * current_ * resistance_;                        // W
  const double speed = std::abs(hinge_ ? hinge_->angleRate(0) : angleRate(0));  // rad/s

  // Electrical power is the mechanical power, back EMF times current, plus the heat of the winding.
  if (battery_ && server_ && server_->batteryDischarge())
    battery_->drain((speedConstant_ * speed * current_ + heat) * event.step);

  // Newton's law of cooling: heat flows to the environment in proportion to the difference of temperatures.
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
  if (world()) world()->setAngularMotor(handle(), axes_, euler_);
}

void AngularMotor::setNumAxes(int n) {
  axes_ = n;
  apply();
}

void AngularMotor::setMotorAxis(int axis, int frame, const Vec3& direction) {
  expectAxis(axis);
  if (frame < 0 || frame > 2)
    throw Error(fmt::format("{}: expected 0 (world), 1 (first body) or 2 (second body), found {}", where(), frame));
  frames_[axis] = frame;
  withBodies([this, axis, frame, direction] { world()->setAxis(handle(), axis, direction, frame); });
}

void AngularMotor::setAxisAngle(int axis, double deg) {
  expectAxis(axis);
  if (world()) world()->setMotorAngle(handle(), axis, degToRad(deg));
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
  return frames_[axis];
}

}  // namespace spark
