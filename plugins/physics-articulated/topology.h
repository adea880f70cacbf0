#pragma once
/// \file
/// The spanning trees that joints make of bodies. They are found anew only when the structure of a world changes.

#include <vector>

#include "api/engine.h"
#include "index.h"

namespace spark::articulated {

/// A body in its tree.
struct TreeBody {
  Index body = 0;           ///< index in Model::bodies
  Index parent = kNone;     ///< index in Topology::treeBodies, below this one's own; kNone: root
  Index treeJoint = kNone;  ///< index in Model::joints: connects to the parent, a root to the world; kNone: none
};

/// A tree: ranges of Topology::treeBodies (parents before children) and of Topology::loopJoints.
struct Tree {
  Index begin = 0, end = 0, loopBegin = 0, loopEnd = 0;
};

/// The trees of a world. Tree joints form them; the remaining joints are loop joints (Featherstone 2008, chapter 4):
/// each closes a loop through its tree or through the world.
struct Topology {
  std::vector<TreeBody> treeBodies;  ///< tree by tree
  std::vector<Tree> trees;
  std::vector<Index> loopJoints;  ///< tree by tree, indices in Model::joints
  std::vector<Index> treeBodyOf;  ///< by body, index in treeBodies
  std::vector<Index> treeOf;      ///< by body, index in trees
  std::size_t maxDepth = 0;       ///< largest number of bodies from a root to a leaf

  /// Replaces the content by the trees of the world. Where joints connect bodies of a tree to the world, the first of
  /// these bodies in order of creation is the root.
  void build(const engine::Model& model);

 private:
  struct JointsOfBodies;
  void growTree(const engine::Model& model, const JointsOfBodies& joints, Index root, Index worldJoint,
                std::vector<bool>& used);
  void findMaxDepth();
};

}  // namespace spark::articulated
