#pragma once
/// \file
/// Trees of bodies, eliminated from the leaves to the roots.
///
/// A body with nothing but forces on it moves by   M u = f.   Held to a parent by rows   J u + K u_p + D x = r   with
/// forces x it moves by
///
///     M u - J^T x = f                      u    motion (velocity / dt)          M    inertia, 6 x 6
///     J u + D x + K u_p = r                x    forces of the joint's rows      D    softness, diagonal, may be 0
///
/// Eliminating u and then x leaves to the parent more inertia and more force, as if the child were a part of it that
/// gives a little:
///
///     W = J M^-1 J^T + D                           how much the child gives where it is held
///     M_p += K^T W^-1 K                            inertia that the parent feels
///     f_p += K^T W^-1 (r - J M^-1 f)               force that the parent feels
///
///          torso                 factor, forward:   leaves first, each hands its K^T W^-1 K and force to the one above
///         /  |  \                                         |
///      arm  head  thigh                                   v
///       |           |            backward:          roots first: from the parent's motion the joint's forces,
///      hand       shank                             from them the child's motion
///                   |
///                  foot ~~~~~
///
/// Every block is 6 x 6. Rows that do not hold (a motor at its bound, a stop that is left) are 0 in J and K and 1 in D:
/// the block stays 6 x 6 and the row's force is 0; a force at a bound acts as a given force.
///
/// Where the world is in place of the parent, K is not there. Rows of a contact with the static world concern one body
/// alone: with D > 0 their forces are (r - J u) / D, which makes them part of M and f of that body:   M += J^T J / D,
/// f += J^T r / D.
///
/// M is positive definite, W is positive semidefinite: no order of rows matters, nothing is divided by a softness that
/// could be 0, and rows that say the same twice with D = 0 get their force once.
///
/// With what is eliminated it is cheap to ask how a single row reaches through the tree (Reach): only the bodies
/// between it and the root answer. Two rows touch each other through what their reaches have in common:
///
///     R_i . R_j = J_i T^-1 J_j^T     with T the whole tree.   coupling.h needs nothing else.

#include <span>
#include <vector>

#include "rows.h"

namespace spark::articulated {

struct Node {
  engine::SolverBody* body = nullptr;
  int parent = -1;
  int joint = -1;                  ///< that holds it to its parent or the world, index in SolverStep::joints; -1: none
  int firstRow = 0, rowCount = 0;  ///< of that joint, not more than 6
  int groundRow = -1;              ///< first of the rows that are part of its inertia, see Row::next
  Frame frame;
  Mat3 inertia;         ///< kg m^2, world frame
  bool changed = true;  ///< one of its rows began to hold or ceased to, or a child changed: to be eliminated anew

  Block gathered;     ///< M: its own and what its children handed up
  Factor own;         ///< of M
  bool held = false;  ///< some row to the parent or the world holds
  Block across;       ///< own.L^-1 J^T, a column for each row
  Block up;           ///< hold.L^-1 K, a row for each row
  Factor hold;        ///< of W
  Block handed;       ///< K^T W^-1 K
  Six target;         ///< r

  Six given;   ///< f without what rows add
  Six load;    ///< f
  Six z, q;    ///< f and r after the forward pass
  Six motion;  ///< u
  Six joined;  ///< x
};

/// What a force along a row of size 1 does on the way to the root: the z and q of the bodies it passes.
struct Reach {
  int node;
  Six z, q;
  Six scaledZ, scaledQ;  ///< divided by the pivots
};

class Elimination {
 public:
  std::span<Node> nodes;  ///< parents before children

  /// Makes room for `count` bodies; what stands in them is left over.
  void begin(std::size_t count) {
    if (storage_.size() < count) storage_.resize(count);
    nodes = std::span(storage_.data(), count);
  }

  /// Eliminates the bodies that changed and those above them; returns whether there were any.
  bool factor(const Rows& rows);
  /// Takes the nodes' loads to z and q. `targets` false: as if all rows wanted 0.
  void forward(bool targets);
  /// From z and q to motion and the joints' forces.
  void backward();
  /// Appends how the row reaches through its tree or trees.
  void reach(const Row& row, std::vector<Reach>& out) const;
  /// How far two rows or a row and all loads after the forward pass touch each other.
  static double touch(const Reach* a, const Reach* aEnd, const Reach* b, const Reach* bEnd);
  double touchLoads(const Reach* a, const Reach* aEnd) const;
  /// Adds what a force along a row does.
  void push(const Reach* a, const Reach* aEnd, double force);

  /// The equation's left side without softness.
  double along(const Row& row) const {
    double sum = dot(row.a, nodes[static_cast<std::size_t>(row.nodeA)].motion);
    if (row.nodeB >= 0) sum += dot(row.b, nodes[static_cast<std::size_t>(row.nodeB)].motion);
    return sum;
  }

 private:
  std::vector<Node> storage_;
  void eliminate(Node& node, const Rows& rows);
};

}  // namespace spark::articulated
