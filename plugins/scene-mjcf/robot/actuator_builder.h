#pragma once
/// \file
/// Makes the controllers and effectors of an MJCF model's actuators.

#include "construction.h"

namespace spark::mjcf {

/// Gives joints the controllers of their actuators, and effectors where there are such classes. Joints must be there.
class ActuatorBuilder {
 public:
  explicit ActuatorBuilder(Construction& construction) : c_(construction) {}
  /// What acts on something that is not there is left out, and named. Throws Error with file:line:column.
  void build();

 private:
  using Actuators = std::vector<const Actuator*>;
  /// The force of an actuator for the joint's own coordinate q, which is 0 in the pose of the file, and a control u:
  /// gain u + bias - (stiffness + gainStiffness u) q - (damping + gainDamping u) dq.
  struct Law {
    double gain = 0, bias = 0, stiffness = 0, damping = 0, gainStiffness = 0, gainDamping = 0;
    double least = -HUGE_VAL, most = HUGE_VAL;            ///< range of u
    double leastForce = -HUGE_VAL, mostForce = HUGE_VAL;  ///< range of the whole force
    double maxForce = HUGE_VAL;                           ///< of all actuators of the joint
  };
  /// The actuators of a controller: NAME_pos, NAME_vel and NAME_tau.
  struct Parts {
    const Actuator *position = nullptr, *velocity = nullptr, *torque = nullptr;
  };
  void onJoint(const Actuators& all, const Construction::MadeJoint& joint);
  std::optional<Parts> partsOf(const Actuators& all) const;
  void makeController(const Parts& parts, const Construction::MadeJoint& joint);
  std::optional<Law> lawOf(const Actuator& x, const Joint& joint, bool alone);
  void makeActuator(const Actuator& x, const Law& law, const Construction::MadeJoint& joint);
  bool isOfEngine(const Actuator& x) const;
  /// A node for an actuator that MuJoCo alone has.
  void makeEngineActuator(const Actuator& x);
  Leaf& makeEffector(const char* className, const std::string& name, Node& parent, const Element& from);
  Leaf& makeEffector(const char* className, const std::string& name, const Construction::MadeJoint& joint,
                     const Element& from);
  std::array<double, 2> controlRange(const Actuator& x) const;
  std::array<double, 2> constantRange(const Actuator& x) const;

  Construction& c_;
};

}  // namespace spark::mjcf
