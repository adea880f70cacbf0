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
  /// `strict`: what is left out is an error.
  Builder(const Model& model, std::string prefix, bool strict, LeftOver& leftOver)
      : model_(model), prefix_(std::move(prefix)), strict_(strict), leftOver_(leftOver) {}
  /// Builds below `root`. Throws Error with file:line:column; the tree is then as before.
  void build(Node& root);
  /// After build(): sensors and actuators have no perceptors and effectors, because those classes are not there.
  bool withoutParts() const { return withoutParts_; }

 private:
  void setOptions(Node& root);

  const Model& model_;
  std::string prefix_;
  bool strict_;
  LeftOver& leftOver_;
  bool withoutParts_ = false;
};

}  // namespace spark::mjcf
