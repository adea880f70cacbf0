#pragma once
/// \file
/// Makes the bodies and joints of an MJCF model.

#include "construction.h"

namespace spark::mjcf {

/// Makes bodies side by side, and the joints between them.
class BodyBuilder {
 public:
  explicit BodyBuilder(Construction& construction) : c_(construction) {}
  /// Throws Error with file:line:column.
  void build();

 private:
  void makeBody(PlacedBody& b);
  void mendSum(PlacedBody& p);
  void compensateGravity(const PlacedBody& b, Leaf& body);
  void makeJoints(const PlacedBody& b);
  /// What MuJoCo alone has of a ball or a free joint. `of`: path of its node from the transform's parent.
  void addFreedom(const PlacedBody& body, const Joint& joint, const std::string& of);
  void makeJoint(const PlacedBody& b, const Joint& joint, Node& child, const std::string& parentPath);
  Node& transformAt(const std::string& name, const Pose& world);

  Construction& c_;
};

}  // namespace spark::mjcf
