#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(he1 30 0 25 0.6 0)`: sets the controller of the joint above it until the next command: target angle [deg] and rate
/// [deg/s], stiffness [Nm/rad], damping [N m s/rad] and torque [Nm].
class ControlEffector : public Effector {
  SPARK_CLASS(ControlEffector, Effector)
 public:
  static void describe(Description<ControlEffector>& d) {
    using E = ControlEffector;
    d.doc("Sets the controller of the joint above it: (name deg deg/s stiffness damping torque).");
    d.link(&E::joint_, Above<IJoint>()).required(kNoJointAbove);
    d.property("maxForce", &E::maxForce_).unit("Nm").min(0).doc("Largest torque of the controller.");
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
    joint->control(0, {.stiffness = n[2],
                       .damping = n[3],
                       .position = unit * n[0],
                       .velocity = unit * n[1],
                       .force = n[4],
                       .maxForce = maxForce_});
    return read.remark();
  }

 private:
  Link<IJoint> joint_;
  double maxForce_ = HUGE_VAL;
};

/// `(name u)`: a MuJoCo actuator on the joint above it. It applies the force gain u + bias - stiffness q - damping dq,
/// with the joint's position q and rate dq [SI units].
class ActuatorEffector : public Effector {
  SPARK_CLASS(ActuatorEffector, Effector)
 public:
  static void describe(Description<ActuatorEffector>& d) {
    using E = ActuatorEffector;
    d.doc("Drives the joint above it with a force of gain u + bias - stiffness q - damping dq: (name u).");
    d.link(&E::joint_, Above<IJoint>()).required(kNoJointAbove);
    d.property("gain", &E::gain_).unit("Nm").doc("Force per control; on a slider N.");
    d.property("bias", &E::bias_).unit("Nm").doc("Constant force; on a slider N.");
    d.property("stiffness", &E::stiffness_).unit("Nm/rad").min(0).doc("Force per angle, against it; on a slider N/m.");
    d.property("damping", &E::damping_).unit("N m s").min(0).doc("Force per rate, against it; on a slider N s/m.");
    d.property("maxForce", &E::maxForce_).unit("Nm").min(0).doc("Largest force; on a slider N.");
    d.property("least", &E::least_).unit("1").doc("Minimum control; smaller values are clamped to it.");
    d.property("most", &E::most_).unit("1").doc("Maximum control; larger values are clamped to it.");
  }
  std::string act(const Element& action) override {
    IJoint* const joint = joint_.get();
    if (!joint) return "expected a joint above it, found none";
    NumberArguments read(action);
    if (double u = 0; read(0, u))
      joint->control(0, {.stiffness = stiffness_,
                         .damping = damping_,
                         .force = gain_ * std::max(least_, std::min(most_, u)) + bias_,
                         .maxForce = maxForce_});
    return read.remark();
  }

 private:
  Link<IJoint> joint_;
  double gain_ = 1, bias_ = 0, stiffness_ = 0, damping_ = 0, maxForce_ = HUGE_VAL, least_ = -HUGE_VAL, most_ = HUGE_VAL;
};

}  // namespace spark
