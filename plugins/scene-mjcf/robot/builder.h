#pragma once
/// \file
/// Makes nodes of an MJCF model.

#include "model.h"
#include "spark/node.h"

namespace spark::mjcf {

/// Makes the nodes of one model: bodies side by side below a Space, with their joints, colliders and shapes, and with
/// the robot's perceptors and effectors.
///
/// A body without joints becomes part of its parent. Poses, anchors and axes are set in double precision.
class Builder {
 public:
  /// `prefix` stands before all names, except those of perceptors and effectors.
  /// `strict`: what is not supported is an error.
  Builder(const Model& model, std::string prefix, bool strict, Unsupported& unsupported)
      : model_(model), prefix_(std::move(prefix)), strict_(strict), unsupported_(unsupported) {}
  /// Builds below `root`. Throws Error with file:line:column; the tree is then as before.
  void build(Node& root);
  /// After build(): sensors and actuators have no perceptors and effectors, because those classes are not there.
  bool withoutParts() const { return withoutParts_; }

 private:
  void refuseLosses(Node& top) const;
  void setOptions(Node& root);
  void compareTimesteps(Node& root);

  const Model& model_;
  std::string prefix_;
  bool strict_;
  Unsupported& unsupported_;
  bool withoutParts_ = false;
};

}  // namespace spark::mjcf
