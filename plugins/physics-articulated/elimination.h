#pragma once
/// \file
/// Forward dynamics of trees of bodies by elimination from the leaves to the roots, in time linear in their number.
///
/// A free body moves by M u = f. A body that the rows J u + K u_p + D x = r connect to its parent moves by
///
///     M u - J^T x = f                      u    motion (velocity / dt)          M    inertia, 6 x 6
///     J u + D x + K u_p = r                x    forces of the joint's rows      D    softness, diagonal, may be 0
///                                          u_p  the parent's motion             f    force, momentum / dt included
///
/// Eliminating u and then x leaves the parent with more inertia and more force:
///
///     W = J M^-1 J^T + D                           Delassus matrix of the joint
///     M_p += K^T W^-1 K                            inertia of the child that the parent feels
///     f_p += K^T W^-1 (r - J M^-1 f)               force of the child that the parent feels
///
///          torso                 factor, forward:    from the leaves: each body hands K^T W^-1 K and its force up
///         /  |  \                                         |
///      arm  head  thigh                                   v
///       |           |            backward:           from the roots: the parent's motion gives the joint's forces,
///      hand       shank                              and these give the child's motion
///                   |
///                  foot ~~~~~
///
/// This is the block LDL^T factorisation of the sparse system of equations in maximal coordinates along the tree
/// (Baraff 1996, "Linear-time dynamics using Lagrange multipliers"). With the terms of all children added, M is the
/// articulated-body inertia of the body, and -f corresponds to its bias force (Featherstone 2008, chapter 7).
///
/// Every block is 6 x 6. A row that is not active (a motor at its bound, a stop that opens) has 0 in J and K and 1 in
/// D, so that its force is 0; a force at a bound is part of f. An inertial force (rows.h) is part of x. A root that is
/// connected to the world has no K.
///
/// Rows of a contact with the static world concern one body alone. With D > 0 their forces are (r - J u) / D, which can
/// be folded into that body: M += J^T D^-1 J, f += J^T D^-1 r. They are "folded rows".
///
/// M is positive definite and W positive semidefinite, so no pivoting is needed. Nothing is divided by a D that could
/// be 0; of redundant rows with D = 0, one gets the whole force (SpatialLdlt).
///
/// A force along a row reaches the nodes on the paths from the row's bodies to the roots; what it does there is the
/// row's path response (PathTerm). With T the equations of the trees and J_i, J_j two rows outside of them, the product
/// of their path responses is the Delassus term J_i T^-1 J_j^T, from which coupling.h solves for the rows' forces.

#include <span>
#include <vector>

#include "rows.h"

namespace spark::articulated {

/// A body in the system of equations, with its connection to its parent. Symbols are those of the head of this file.
struct Node {
  const engine::Body* body = nullptr;       ///< in the model
  engine::DynamicState* dynamic = nullptr;  ///< in the state
  Index parent = kNone;                     ///< node, before this one; kNone: root
  Index joint = kNone;                      ///< tree joint, index in Model::joints; kNone: a free root
  Index firstRow = 0, rowCount = 0;         ///< rows of that joint, at most 6
  Index firstFolded = kNone;                ///< first folded row, see Row::nextFolded
  RigidBodyState state;
  Mat3 worldInertia;    ///< kg m^2, about the centre of mass, world axes
  bool changed = true;  ///< a row of it or of a node below began or ceased to hold: factor() has to renew it

  // Factorisation.
  SpatialMatrix inertia;        ///< M: of the body, its folded rows and its children
  SpatialLdlt inertiaFactor;    ///< of M
  bool connected = false;       ///< a row of the tree joint is active; else the blocks below are invalid
  SpatialMatrix halfJ;          ///< L_M^-1 J^T, one column per row of the joint
  SpatialMatrix halfK;          ///< L_W^-1 K, one row per row of the joint; only with a parent
  SpatialLdlt delassusFactor;   ///< of W
  SpatialMatrix parentInertia;  ///< K^T W^-1 K; only with a parent
  SpatialVector target;         ///< r

  // Solution.
  SpatialVector externalForce;  ///< f without rows: forces of the step, and momentum / dt
  SpatialVector force;          ///< f
  SpatialVector z;              ///< L_M^-1 f
  SpatialVector q;              ///< L_W^-1 (r - J M^-1 f)
  SpatialVector motion;         ///< u
  SpatialVector jointForces;    ///< x
};

/// How a unit force along a row acts on one node of the path to the root: the node's z and q for this force alone.
struct PathTerm {
  Index node;
  SpatialVector z, q;
  SpatialVector scaledZ, scaledQ;  ///< D^-1 z and D^-1 q, with the D of the two factorisations
};

/// The path response of a row: its terms, nodes in falling order from the row's bodies to the roots. Valid as long as
/// the array of the terms.
struct PathResponse {
  const PathTerm *first, *last;
  const PathTerm* begin() const { return first; }
  const PathTerm* end() const { return last; }
};

/// The trees of an island. Memory is kept from step to step.
class Elimination {
 public:
  std::span<Node> nodes;  ///< parents before children

  /// Sets the number of nodes. Their content is that of an earlier step.
  void begin(std::size_t count) {
    if (storage_.size() < count) storage_.resize(count);
    nodes = std::span(storage_.data(), count);
  }

  /// Factorises the nodes that changed and all above them. Returns whether there were any.
  bool factor(const Rows& rows);
  /// Computes z and q from the nodes' `force`, which the children's forces are added to. With `useTargets` false, r is
  /// 0 in all rows.
  void forward(bool useTargets);
  /// Computes motion and joint forces from z and q.
  void backward();
  /// Appends the path response of a row, whose bodies may be in two trees.
  void appendPathResponse(const Row& row, std::vector<PathTerm>& out) const;
  /// The Delassus term J_i T^-1 J_j^T of two rows.
  static double delassusTerm(PathResponse i, PathResponse j);
  /// J_i u of the motion u that backward() would compute now, after forward().
  double predictedMotion(PathResponse i) const;
  /// Adds the effect of a force along a row to z and q, between forward() and backward().
  void applyForce(PathResponse i, double force);

  /// J u of a row.
  double motionAlong(const Row& row) const {
    double sum = dot(row.jacobianA, nodes[row.nodeA].motion);
    if (row.nodeB != kNone) sum += dot(row.jacobianB, nodes[row.nodeB].motion);
    return sum;
  }

 private:
  std::vector<Node> storage_;
  void factorNode(Node& node, const Rows& rows);
};

}  // namespace spark::articulated
