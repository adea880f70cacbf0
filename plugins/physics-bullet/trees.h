#pragma once
/// \file
/// The trees that joints make of the bodies of a model, one by one.

#include <vector>

#include "api/joint_trees.h"

namespace spark::bullet {

using engine::Index;
using engine::kNone;
using Link = engine::TreeLink;  ///< here `parent` is an index in Tree::links

/// A tree, parents first.
struct Tree {
  std::vector<Link> links;
};

/// See engine::JointTrees.
struct Trees {
  explicit Trees(const engine::Model& model);
  std::vector<Tree> trees;
  std::vector<Index> leftOver;  ///< joints in no tree
};

}  // namespace spark::bullet
