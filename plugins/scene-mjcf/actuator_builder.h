#pragma once
/// \file
/// Makes the controllers and effectors of an MJCF model's actuators.

#include "construction.h"

namespace spark::mjcf {

/// Gives joints the controllers of their actuators, and effectors where there are such classes. Joints must be there.
class ActuatorBuilder {
 public:
  explicit ActuatorBuilder(Construction& construction) : c_(construction) {}
  /// Throws Error with file:line:column.
  void build();

 private:
  using Actuators = std::vector<const Actuator*>;
  void onJoint(const Actuators& all, const Construction::MadeJoint& joint);
  bool makeController(const Actuators& all, const Construction::MadeJoint& joint, double maxForce);
  void makeActuator(const Actuator& x, const Construction::MadeJoint& joint, double maxForce);

  Construction& c_;
};

}  // namespace spark::mjcf
