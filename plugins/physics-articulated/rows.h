#pragma once
/// \file
/// Constraints as scalar rows: what a joint or a contact asks of the motion of one or two bodies, in one direction.
///
/// With `motion` a body's new velocity divided by the step (so that a force changes it by force / mass), a row is
///
///     a . motion(nodeA) + b . motion(nodeB) + softness * force = target,     low <= force <= high,
///
/// and at a bound the equation gives way in the direction in which the bound holds: at `low` the left side may be
/// larger, at `high` smaller. The force acts on the bodies along a and b. softness = cfm / dt, target = wanted velocity
/// / dt.

#include <cstdint>
#include <span>
#include <vector>

#include "angles.h"
#include "api/solver.h"
#include "six.h"

namespace spark::articulated {

/// Whether a row's equation holds or its force stands at a bound. `off`: neither, there is no force.
enum class State : std::uint8_t { holds, low, high, off };

struct Row {
  Six a = Six::zero(), b = Six::zero();
  double target = 0, softness = 0;
  double low = -HUGE_VAL, high = HUGE_VAL;
  double force = 0;            ///< N, Nm: out
  int nodeA = -1, nodeB = -1;  ///< of the island; -1: none
  State state = State::holds;
  std::int8_t axis = -1;  ///< motor or stop of this axis of its joint
  std::int8_t stop = 0;   ///< 1 at the low stop, 2 at the high one
  int frictionOf = -1;    ///< the bounds are times the force of this row
  bool inBody = false;    ///< is part of body A's inertia
  int next = -1;          ///< the next row of the same body that is

  bool holds() const { return state == State::holds; }
  bool bounded() const { return low != -HUGE_VAL || high != HUGE_VAL; }
  /// The force while the equation does not hold.
  double bound() const { return state == State::low ? low : state == State::high ? high : 0; }
};

/// Rows of an island. Memory stays; what is begun anew is written over.
class Rows {
 public:
  void clear() { count_ = 0; }
  int size() const { return count_; }
  /// Room for `most` more rows, of which take() keeps some.
  Row* offer(int most) {
    if (rows_.size() < static_cast<std::size_t>(count_ + most)) rows_.resize(static_cast<std::size_t>(count_ + most));
    return rows_.data() + count_;
  }
  void take(int count) { count_ += count; }
  void reserve(std::size_t rows) {
    if (rows_.size() < rows) rows_.resize(rows);
  }
  Row& operator[](int i) { return rows_[static_cast<std::size_t>(i)]; }
  const Row& operator[](int i) const { return rows_[static_cast<std::size_t>(i)]; }
  Row* begin() { return rows_.data(); }
  Row* end() { return rows_.data() + count_; }
  const Row* begin() const { return rows_.data(); }
  const Row* end() const { return rows_.data() + count_; }

 private:
  std::vector<Row> rows_;
  int count_ = 0;
};

/// A body while its island is solved: its state, and the forces on it.
struct Frame {
  Vec3 position, velocity, spin;
  Mat3 rotation;
  Turn turn;
  Vec3 force, torque;
};

/// What all rows of a step share.
struct RowScale {
  double perSecond;            ///< 1 / dt
  double erp, cfm;             ///< the world's
  double contactSurfaceLayer;  ///< m
};

/// Most rows that a joint and a contact have.
inline constexpr int kJointRows = 6, kContactRows = 3;

/// Writes a joint's rows for bodies `a` and `b` (nullptr: the world) and returns how many. Motors that press against a
/// stop add their force to the bodies instead. Fills a, b, target, softness, bounds, axis and stop.
int jointRows(const engine::SolverJoint& joint, Frame& a, Frame* b, const RowScale& scale, Row* out);

/// The same for a contact, at most 3: the normal first. `reversed`: the normal counts the other way round.
int contactRows(const engine::Contact& contact, bool reversed, const Frame& a, const Frame* b, const RowScale& scale,
                Row* out);

}  // namespace spark::articulated
