#pragma once
/// \file
/// What agents get of a robot: drives and sensors.

#include "elements.h"
#include "robot/model.h"

namespace spark::urdf {

/// Adds actuators and sensors to a model with all its bodies and joints, as transmissions and `gazebo` elements say.
class AgentParts {
 public:
  /// `root`: the element `robot`. All must outlive this.
  AgentParts(const Element& root, mjcf::Model& model, Unsupported& unsupported)
      : root_(root), model_(model), unsupported_(unsupported) {}
  void add() {
    drives();
    sensors();
  }

 private:
  void drives();
  static std::string_view interfaceOf(const Element& transmission, const Element& joint);
  void reductions(const Element& around);
  void drive(const Element& from, const mjcf::Joint& joint, bool byForceAlone);
  void sensors();
  const Element root_;
  mjcf::Model& model_;
  Unsupported& unsupported_;
};

}  // namespace spark::urdf
