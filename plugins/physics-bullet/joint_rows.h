#pragma once
/// \file
/// Rows of joints: motors and stops of all, and the constraints of those that are in no tree.

#include "api/engine.h"
#include "api/laws_by_joint.h"
#include "api/scene_joint.h"
#include "row_solver.h"

namespace spark::bullet {

/// Rows of one joint, or of one degree of freedom.
struct JointRows {
  const engine::Step& step;
  const std::vector<engine::JointSoftness>& softness;  ///< by joint
  const engine::LawsByJoint& laws;
  RowSolver& out;

  /// Motor, stops, damping and armature of a degree of freedom of a tree.
  void writeDof(TreeBody& tree, const Dof& dof) const;
  /// The damping of a ball joint.
  void writeBallDamping(Index joint, const Side& a, const Side& b) const;
  /// All rows of a joint that is in no tree.
  void writeJoint(Index joint, const Side& a, const Side& b) const;

 private:
  void writeLaws(Index joint, int axis, const Row& row) const;
  void writeAxis(Index joint, int axis, Row row, double position, double rate) const;
};

}  // namespace spark::bullet
