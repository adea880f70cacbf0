#pragma once
/// \file
/// What Gazebo's extensions say about links and joints.

#include "elements.h"
#include "robot/model.h"

namespace spark::urdf {

/// Applies the elements `gazebo` of a robot to a model with all its bodies and joints. Sensors are no part of it.
class GazeboReader {
 public:
  /// `root`: the element `robot`. All must outlive this.
  GazeboReader(const Element& root, mjcf::Model& model, Unsupported& unsupported)
      : root_(root), model_(model), unsupported_(unsupported) {}
  void apply();
  /// True if an element says that the robot does not move.
  static bool isStatic(const Element& root);

 private:
  void onRobot(const Element& gazebo);
  void onLink(const Element& gazebo, mjcf::Body& body);
  void onJoint(const Element& gazebo, mjcf::Joint& joint);
  void friction(const Element& e, mjcf::Body& body);
  void color(const Element& e, mjcf::Body& body);
  bool flag(const Element& e);
  std::optional<double> number(const Element& e);
  void separate();
  const Element root_;
  mjcf::Model& model_;
  Unsupported& unsupported_;
  std::set<std::string, std::less<>> colliding_;  ///< names of links that collide with others of the robot
};

}  // namespace spark::urdf
