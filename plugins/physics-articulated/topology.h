#pragma once
/// \file
/// The trees that joints make of bodies. Found once for each structure of a world.

#include <vector>

#include "api/solver.h"

namespace spark::articulated {

/// A body's place in its tree. `joint` holds it to `parent`, or to the world where there is none; -1: it hangs on
/// nothing.
struct Branch {
  int body = 0;     ///< index in SolverStep::bodies
  int parent = -1;  ///< branch, before this one
  int joint = -1;   ///< index in SolverStep::joints
};

/// Branches start..end, parents first, and the joints (extraStart..extraEnd) that close loops in it.
struct Tree {
  int start = 0, end = 0, extraStart = 0, extraEnd = 0;
};

struct Topology {
  std::vector<Branch> branches;
  std::vector<Tree> trees;
  std::vector<int> extraJoints;
  std::vector<int> branchOf, treeOf;  ///< by body
  std::size_t depth = 0;              ///< bodies from a root to the farthest leaf

  /// Throws away what was there and finds the trees anew. Bodies that a joint holds to the world become roots where
  /// they can.
  void find(const engine::SolverStep& step);
};

}  // namespace spark::articulated
