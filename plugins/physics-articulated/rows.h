#pragma once
/// \file
/// Constraints as scalar rows: what a joint or a contact demands of the motion of one or two bodies in one direction.
///
/// Let u be a body's motion: its new velocity divided by the step, so that a force changes it by M^-1 force. A row is
///
///     J_A u_A + J_B u_B + D x = r,     low <= x <= high,     D = cfm / dt,     r = target velocity / dt,
///
/// with the force x. At a bound the equation becomes an inequality: at `low` the left side may be larger than r, at
/// `high` it may be smaller. Together the rows are a linear complementarity problem with bounds (Cottle, Pang and Stone
/// 1992, The Linear Complementarity Problem). The row's force on the bodies is J_A^T x and J_B^T x.
///
/// Beside x there may be an inertial force along a row, of a rotor that turns with a joint's axis and of its damping:
///
///     y = I (s - J u),     I = armature + damping dt,     s = armature / I times the present velocity / dt.
///
/// It acts whether the equation holds or not. With the total force t = x + y a row that holds is J u + D' t = r' with
/// D' = D / (1 + D I) and r' = (r + D I s) / (1 + D I); else y alone makes it J u + t / I = s.
///
/// CFM and ERP are those of ODE (Smith, ODE manual, "Joint error and the Error Reduction Parameter" and "Soft
/// constraint and Constraint Force Mixing").

#include <span>
#include <vector>

#include "api/engine.h"
#include "api/laws_by_joint.h"
#include "api/scene_joint.h"
#include "index.h"
#include "rotation.h"
#include "spatial.h"

namespace spark::articulated {

/// Which of a row's conditions is active. `holds`: the equation. `atLow`, `atHigh`: the force is at that bound. `off`:
/// none; the force is 0.
enum class RowState : std::uint8_t { holds, atLow, atHigh, off };

/// The stop of a joint's axis that a row belongs to.
enum class Stop : std::uint8_t { none, low, high };

/// Row::axis of a row that is neither a motor's nor a stop's.
inline constexpr std::uint8_t kNoAxis = 0xff;

/// One scalar row. Forces are in N or Nm; u and r in m/s^2 or rad/s^2.
struct Row {
  SpatialVector jacobianA = SpatialVector::zero(), jacobianB = SpatialVector::zero();
  double target = 0;                        ///< r
  double softness = 0;                      ///< D, at least 0
  double low = -HUGE_VAL, high = HUGE_VAL;  ///< low <= 0 <= high
  double force = 0;                         ///< x; set by System::solve()
  double inertia = 0, inertialTarget = 0;   ///< I and s
  Index nodeA = kNone, nodeB = kNone;       ///< nodes of the island's trees; nodeB kNone: the static world
  RowState state = RowState::holds;
  RowState frictionless = RowState::holds;  ///< its state in the solution without the friction of pyramids
  std::uint8_t axis = kNoAxis;              ///< of the joint, 0..2, for the row of a motor or stop
  Stop stop = Stop::none;
  Index normalRow = kNone;   ///< friction: `low` and `high` are multiples of this row's force
  bool folded = false;       ///< is part of body A's inertia and force, see elimination.h
  Index nextFolded = kNone;  ///< next folded row of the same body

  bool holds() const { return state == RowState::holds; }
  /// The row is one of the equations: it holds, or has an inertial force.
  bool active() const { return holds() || inertia > 0; }
  /// D and r of the equation for the total force; the row is active.
  double totalSoftness() const {
    return !holds() ? 1 / inertia : inertia > 0 ? softness / (1 + softness * inertia) : softness;
  }
  double totalTarget() const {
    if (!holds()) return inertialTarget;
    if (inertia == 0) return target;
    const double share = softness * inertia;
    return (target + share * inertialTarget) / (1 + share);
  }
  bool bounded() const { return low != -HUGE_VAL || high != HUGE_VAL; }
  /// The force while the equation does not hold; infinite where the state's bound is.
  double bound() const { return state == RowState::atLow ? low : state == RowState::atHigh ? high : 0; }
};

/// The rows of an island. Memory is kept from step to step; pointers and references end with the next prepare().
class Rows {
 public:
  /// Removes all rows.
  void clear() { count_ = 0; }
  Index size() const { return count_; }
  /// Returns memory for up to `max` rows after the last one. Its content is that of an earlier step.
  Row* prepare(Index max) {
    if (rows_.size() < count_ + max) rows_.resize(count_ + max);
    return rows_.data() + count_;
  }
  /// Appends the first `count` of the rows that prepare() returned.
  void commit(Index count) { count_ += count; }
  /// Allocates memory for `rows` rows.
  void reserve(std::size_t rows) {
    if (rows_.size() < rows) rows_.resize(rows);
  }
  /// Rows first .. first + count - 1.
  std::span<Row> range(Index first, Index count) { return {rows_.data() + first, count}; }
  std::span<const Row> range(Index first, Index count) const { return {rows_.data() + first, count}; }
  Row& operator[](Index i) { return rows_[i]; }
  const Row& operator[](Index i) const { return rows_[i]; }
  Row* begin() { return rows_.data(); }
  Row* end() { return rows_.data() + count_; }
  const Row* begin() const { return rows_.data(); }
  const Row* end() const { return rows_.data() + count_; }

 private:
  std::vector<Row> rows_;
  Index count_ = 0;
};

/// State of a body at the start of the step, and the forces on it; world frame.
struct RigidBodyState {
  Vec3 position;         ///< m, of the centre of mass
  Vec3 linearVelocity;   ///< m/s
  Vec3 angularVelocity;  ///< rad/s
  Mat3 rotation;
  Quaternion orientation;  ///< the same as `rotation`
  Vec3 force, torque;      ///< N, Nm, without those of rows
};

/// What all rows of a step share.
struct StepConstants {
  double inverseDt;            ///< 1 / dt [1/s]
  double erp, cfm;             ///< the world's
  double contactSurfaceLayer;  ///< allowed penetration [m]
};

/// Largest number of rows of a joint and of a contact.
inline constexpr Index kMaxJointRows = 6, kMaxContactRows = 3;

/// `coordinates`: where the axes are, for the turns of their angles; `laws`: those of joint `index`. Writes the rows of
/// a joint between bodies `a` and `b` (nullptr: the world) to `out`, which has room for kMaxJointRows. Returns their
/// number. Sets Jacobians, target, softness, bounds, axis and stop. A motor at a stop has no row of its own: its force
/// is added to `force` and `torque` of the bodies.
Index writeJointRows(const engine::Joint& joint, const engine::JointSoftness& soft, const engine::Motors& motors,
                     const engine::JointCoordinates& coordinates, const engine::LawsByJoint& laws, Index index,
                     RigidBodyState& a, RigidBodyState* b, const StepConstants& constants, Row* out);

/// The bodies of a contact that is a constraint.
struct ContactBodies {
  Index a = kNone, b = kNone;  ///< b kNone: the static world; a kNone: the contact is no constraint
  bool reversed = false;       ///< geom A is static: a is the body of geom B, and the normal points out of a
  explicit ContactBodies(const engine::Contact& c) {
    if (!c.solve) return;
    reversed = c.bodyA == kNone;
    a = reversed ? c.bodyB : c.bodyA;
    b = reversed ? kNone : c.bodyB;
  }
};

/// Writes the rows of a contact to `out`, which has room for kMaxContactRows: the normal, then two of friction unless
/// mu is 0. Returns their number. Sets Jacobians, target, softness, bounds and normalRow (0, counted from `out`).
/// `reversed`: the contact's normal points out of `a`.
Index writeContactRows(const engine::Contact& contact, bool reversed, const RigidBodyState& a, const RigidBodyState* b,
                       const StepConstants& constants, Row* out);

}  // namespace spark::articulated
