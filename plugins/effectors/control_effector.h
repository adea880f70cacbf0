#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(he1 30 0 25 0.6 0)`: sets the controller of the joint above it until the next command: target angle [deg] and rate
/// [deg/s], stiffness [Nm/rad], damping [N m s/rad] and torque [Nm].
///
/// The three parts may have gears and limits as the actuators of an MJCF file: the target is then a length, the gear
/// times the angle. Vectors hold the numbers of position, rate and torque.
class ControlEffector : public Effector {
  SPARK_CLASS(ControlEffector, Effector)
 public:
  static void describe(Description<ControlEffector>& d) {
    using E = ControlEffector;
    d.doc("Sets the controller of the joint above it: (name deg deg/s stiffness damping torque).");
    d.link(&E::joint_, Above<IJoint>()).required(kNoJointAbove);
    d.property("maxForce", &E::maxForce_).unit("Nm").min(0).doc("Largest torque of the controller.");
    d.property("gears", &E::gears_).unit("1").doc("Gears of position, rate and torque; not 0.");
    d.property("leastControls", &E::least_)
        .unit("SI")
        .doc("Least position, rate and torque that count [rad, rad/s, Nm].");
    d.property("mostControls", &E::most_).unit("SI").doc("Largest position, rate and torque that count.");
    d.property("leastForces", &E::leastForces_)
        .unit("Nm")
        .doc("Least force of each of the three parts; on a slider N.");
    d.property("mostForces", &E::mostForces_)
        .unit("Nm")
        .doc("Largest force of each of the three parts; on a slider N.");
    d.property("reference", &E::reference_).unit("rad").doc("Angle in messages where the joint's is 0; on a slider m.");
  }
  std::string act(const Element& action) override {
    IJoint* const joint = joint_.get();
    if (!joint) return "expected a joint above it, found none";
    NumberArguments read(action);
    double n[5];
    for (std::size_t i = 0; i < 5; ++i)
      if (!read(i, n[i])) return read.remark();
    if (n[2] < 0 || n[3] < 0)
      return fmt::format("expected a stiffness and a damping of 0 or more, found {} and {}", n[2], n[3]);
    const double unit = joint->jointType() == engine::JointType::slider ? 1 : degToRad(1);
    engine::Control law{.position = limited(0, unit * n[0]) / gears_[0] - reference_,
                        .velocity = limited(1, unit * n[1]) / gears_[1],
                        .force = std::max(leastForces_[2], std::min(mostForces_[2], gears_[2] * limited(2, n[4]))),
                        .maxForce = maxForce_};
    const double stiffness = gears_[0] * gears_[0] * n[2], damping = gears_[1] * gears_[1] * n[3];
    if (isBounded(0))
      law.add({stiffness * law.position, stiffness, 0, leastForces_[0], mostForces_[0]});
    else
      law.stiffness = stiffness;
    if (isBounded(1))
      law.add({damping * law.velocity, 0, damping, leastForces_[1], mostForces_[1]});
    else
      law.damping = damping;
    joint->control(0, law);
    watch(joint->angleRate(0) - law.velocity, damping > 0 || stiffness > 0);
    return read.remark();
  }

 private:
  /// A controller that is too stiff for the inertia that it moves drives its joint away faster and faster: the error of
  /// its rate grows by the same factor from command to command, which no load does for long.
  void watch(double error, bool controls) {
    constexpr double kFactor = 1.5, kFast = 10;  // rad/s, on a slider m/s
    constexpr int kCommands = 4;
    growth_ = controls && std::abs(error) > kFactor * std::abs(lastError_) ? growth_ + 1 : 0;
    lastError_ = error;
    if (growth_ >= kCommands && std::abs(error) > kFast)
      refuse(0, [&] {
        return std::string(
            "its joint turns faster with each command: the gains are too high for the inertia that it moves. Expected "
            "a smaller stiffness or damping, or shorter steps of the world (World.timestep).");
      });
  }
  double limited(int part, double v) const { return std::max(least_[part], std::min(most_[part], v)); }
  bool isBounded(int part) const { return std::isfinite(leastForces_[part]) || std::isfinite(mostForces_[part]); }
  Link<IJoint> joint_;
  double maxForce_ = HUGE_VAL, reference_ = 0;
  Vec3 gears_{1, 1, 1}, least_{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, most_{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3 leastForces_{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, mostForces_{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  // For the line in the log alone.
  double lastError_ = 0;
  int growth_ = 0;
};

/// `(name u)`: a MuJoCo actuator on the joint above it. It applies the force gain u + bias - (stiffness + gainStiffness
/// u) q - (damping + gainDamping u) dq, with the joint's position q and rate dq [SI units]. The forces of several
/// actuators of one joint add up, each in its own range.
class ActuatorEffector : public Effector {
  SPARK_CLASS(ActuatorEffector, Effector)
 public:
  static void describe(Description<ActuatorEffector>& d) {
    using E = ActuatorEffector;
    d.doc("Drives the joint above it with a force of gain u + bias - stiffness q - damping dq: (name u).");
    d.link(&E::joint_, Above<IJoint>()).required(kNoJointAbove);
    d.property("gain", &E::gain_).unit("Nm").doc("Force per control; on a slider N.");
    d.property("bias", &E::bias_).unit("Nm").doc("Constant force; on a slider N.");
    d.property("stiffness", &E::stiffness_).unit("Nm/rad").doc("Force per angle, against it; on a slider N/m.");
    d.property("damping", &E::damping_).unit("N m s").doc("Force per rate, against it; on a slider N s/m.");
    d.property("gainStiffness", &E::gainStiffness_).unit("Nm/rad").doc("Stiffness per control.");
    d.property("gainDamping", &E::gainDamping_).unit("N m s").doc("Damping per control.");
    d.property("maxForce", &E::maxForce_)
        .unit("Nm")
        .min(0)
        .doc("Maximum force of the joint's actuators; on a slider N.");
    d.property("leastForce", &E::leastForce_).unit("Nm").doc("Least force of this actuator; on a slider N.");
    d.property("mostForce", &E::mostForce_).unit("Nm").doc("Largest force of this actuator; on a slider N.");
    d.property("least", &E::least_).unit("1").doc("Minimum control; smaller values are clamped to it.");
    d.property("most", &E::most_).unit("1").doc("Maximum control; larger values are clamped to it.");
    d.property("control", &E::control, &E::setControl).unit("1").savedByClass().doc("The control u.");
  }
  std::string act(const Element& action) override {
    if (!joint_.get()) return "expected a joint above it, found none";
    NumberArguments read(action);
    if (double u = 0; read(0, u)) setControl(u);
    return read.remark();
  }

 protected:
  void saveState(StateWriter& out) const override { out.write(control_); }
  void loadState(StateReader& in) override { control_ = in.readNumber(); }

 private:
  double control() const { return control_; }
  void setControl(double u) {
    control_ = u;
    IJoint* const joint = joint_.get();
    if (!joint) return;
    engine::Control sum;
    for (const auto& sibling : parent()->children())
      if (const auto actuator = sibling->as<ActuatorEffector>()) actuator->addTo(sum);
    joint->control(0, sum);
  }
  void addTo(engine::Control& sum) const {
    const double u = std::max(least_, std::min(most_, control_));
    sum.maxForce = std::min(sum.maxForce, maxForce_);
    sum.addLaw(
        {gain_ * u + bias_, stiffness_ + gainStiffness_ * u, damping_ + gainDamping_ * u, leastForce_, mostForce_});
  }
  Link<IJoint> joint_;
  double gain_ = 1, bias_ = 0, stiffness_ = 0, damping_ = 0, gainStiffness_ = 0, gainDamping_ = 0, maxForce_ = HUGE_VAL,
         leastForce_ = -HUGE_VAL, mostForce_ = HUGE_VAL, least_ = -HUGE_VAL, most_ = HUGE_VAL, control_ = 0;
};

/// `(name u)`: sets the control of the actuator beside it, one that only the engine in use has.
class EngineActuatorEffector : public Effector {
  SPARK_CLASS(EngineActuatorEffector, Effector)
 public:
  static void describe(Description<EngineActuatorEffector>& d) {
    d.doc("Sets the control of the actuator beside it, for instance a MujocoActuator: (name u).");
    d.link(&EngineActuatorEffector::actuator_, Above<Transform>().child<IActuator>())
        .required("It does nothing. Put it beside the actuator it belongs to.");
  }
  std::string act(const Element& action) override {
    IActuator* const actuator = actuator_.get();
    if (!actuator) return "expected an actuator beside it, found none";
    NumberArguments read(action);
    if (double u = 0; read(0, u)) actuator->setControl(u);
    return read.remark();
  }

 private:
  Link<IActuator> actuator_;
};

}  // namespace spark
