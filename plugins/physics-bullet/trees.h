#pragma once
/// \file
/// The trees that joints make of the bodies of a model.

#include <vector>

#include "api/model.h"

namespace spark::bullet {

using engine::Index;
using engine::kNone;

/// A body in its tree.
struct Link {
  Index body = 0;
  Index parent = kNone;  ///< index in Tree::links; kNone: the root
  Index joint = kNone;   ///< the joint to the parent, or of a root to the world; kNone: a root that is free
  bool childIsA = true;  ///< the body is body a of that joint
  Pose zero;             ///< of the body in its parent, or in the world, where the joint's coordinates are 0
};

/// A tree, parents first.
struct Tree {
  std::vector<Link> links;
};

/// All trees, in the order of their roots' bodies, those with a joint to the world first.
struct Trees {
  explicit Trees(const engine::Model& model);
  std::vector<Tree> trees;
  std::vector<Index> leftOver;  ///< joints in no tree: those that close a loop, and angular motors
};

}  // namespace spark::bullet
