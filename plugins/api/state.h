#pragma once
/// \file
/// Where everything in a physical world is, and what drives it: the part that a step changes. World frame, SI units,
/// radians; indices are those of the model.

#include <algorithm>
#include <utility>
#include <vector>

#include "api/model.h"
#include "spark/abi/api/state.h"

namespace spark::engine {

/// Where a body is and how it moves, world frame.
struct BodyState {
  Vec3 position;         ///< of the centre of mass [m]
  Vec3 linearVelocity;   ///< m/s
  Vec3 angularVelocity;  ///< rad/s
  Mat3 rotation;
};

/// The state of a body that a step changes, world frame. What is read together lies together, in cache lines.
struct alignas(64) DynamicState {
  std::array<double, 4> quaternion{1, 0, 0, 0};  ///< w x y z, body to world, of length 1
  Vec3 position = Vec3::Zero();                  ///< of the centre of mass [m]
  bool awake = true;                             ///< false: the body sleeps
  bool moved = false;                            ///< it is in State::moved
  /// Rises whenever pose or velocity are written, by whomever: a solver that keeps them in memory of its own knows by
  /// it whether they are still the same.
  std::uint32_t version = 1;
  Mat3 rotation = Mat3::Identity();     ///< the same as `quaternion`, as a matrix
  Vec3 angularVelocity = Vec3::Zero();  ///< rad/s
  Vec3 linearVelocity = Vec3::Zero();   ///< m/s
  Vec3 force = Vec3::Zero();            ///< N, accumulated for the next step, which clears it
  Vec3 torque = Vec3::Zero();           ///< Nm, likewise
};

/// The motor of one axis of a joint: it reaches its target velocity with a force of at most maxForce, see JointAxis.
struct Motor {
  double velocity = 0;  ///< target [rad/s or m/s]
  double maxForce = 0;  ///< bound of the force, at least 0; 0: no motor
};
/// The motors of a joint, by axis.
using Motors = std::array<Motor, 3>;

/// A term of a controller with a range of its own: force - stiffness angle - damping rate, clamped. Units as in
/// Control, but stiffness and damping may be of any sign.
struct ControlTerm {
  double force = 0, stiffness = 0, damping = 0;
  double least = -HUGE_VAL, most = HUGE_VAL;
  double at(double angle, double rate) const {
    return std::max(least, std::min(most, force - stiffness * angle - damping * rate));
  }
};

/// The controller of one axis of a joint, in place of its motor: a force of
///
///     stiffness (position - angle) + damping (velocity - rate) + force + the terms,   at most maxForce,
///
/// in each of an engine's own steps. Units as in JointAxis.
struct Control {
  static constexpr int kMaxTerms = 4;
  double stiffness = 0, damping = 0;  ///< kp [Nm/rad or N/m] and kd [N m s or N s/m], 0 or more
  double position = 0, velocity = 0;  ///< targets [rad and rad/s, or m and m/s]
  double force = 0;                   ///< feed-forward [Nm or N]; alone it is a motor that is given its torque
  double maxForce = HUGE_VAL;         ///< bound of the sum [Nm or N]
  int termCount = 0;                  ///< of `terms`; 0 for most controllers
  std::array<ControlTerm, kMaxTerms> terms{};
  /// Appends a term. Returns false when there is no room.
  bool add(const ControlTerm& term) {
    if (termCount == kMaxTerms) return false;
    terms[static_cast<std::size_t>(termCount++)] = term;
    return true;
  }
  /// Adds a law to a controller whose targets are 0: as a term where it has a range, or a stiffness or
  /// damping below 0. Returns false when there is no room for that, which it then does not have.
  bool addLaw(const ControlTerm& law) {
    const bool isTerm = std::isfinite(law.least) || std::isfinite(law.most) || law.stiffness < 0 || law.damping < 0;
    if (isTerm && add(law)) return true;
    stiffness += std::max(0.0, law.stiffness);
    damping += std::max(0.0, law.damping);
    force += law.force;
    return !isTerm;
  }
  /// The sum of the terms.
  double termsAt(double angle, double rate) const {
    double sum = 0;
    for (int i = 0; i < termCount; ++i) sum += terms[static_cast<std::size_t>(i)].at(angle, rate);
    return sum;
  }
  double at(double angle, double rate) const {
    const double own = stiffness * (position - angle) + damping * (velocity - rate) + force;
    return std::clamp(termCount == 0 ? own : own + termsAt(angle, rate), -maxForce, maxForce);
  }
};
/// A controller and the axis that it acts on.
struct AxisControl {
  Index joint = kNone;
  int axis = 0;
  Control control;
};

/// A number that acts on the world through a block of its model, and changes without it: the control of an actuator.
struct BlockInput {
  std::uint64_t kind = 0;  ///< that of the block
  double value = 0;
};

/// What acts along one axis of a joint in one step, beside its motor and its stops: a force of
///
///     force - resistance (velocity after the step),   at most maxForce.
///
/// Controllers, springs, damping and the inertia of rotors come in this form. It is implicit in time: however stiff
/// they are for the bodies and the step, they do not overshoot.
struct AxisLaw {
  Index joint = kNone;
  int axis = 0;                ///< of the stops that count the coordinate; a ball joint: 0..2, x y z of the world
  Vec3 along = Vec3::Zero();   ///< world, unit vector: the force acts on a, and its opposite on b
  double force = 0;            ///< at rest [Nm or N]
  double resistance = 0;       ///< above 0 [N m s or N s/m]
  double maxForce = HUGE_VAL;  ///< [Nm or N]
  bool operator==(const AxisLaw&) const = default;
};

/// What a step measures at a joint with `wantsFeedback`: force [N] and torque about the body's centre [Nm] on a and b;
/// zero on the world.
struct JointState {
  Vec3 forceA = Vec3::Zero(), torqueA = Vec3::Zero(), forceB = Vec3::Zero(), torqueB = Vec3::Zero();
};

/// Where the axes of a joint are, as its stops count: continuous, so a hinge that has turned once is at 2 pi, not at 0.
/// A pose has no turns. They are counted from step to step, and a step that turns an axis by pi or more is taken for
/// one the other way round.
struct JointCoordinates {
  std::array<double, 3> angle{0, 0, 0};        ///< as the poses have it, -pi..pi [rad]
  std::array<std::int32_t, 3> turns{0, 0, 0};  ///< whole turns beside it
  /// The coordinate of a rotational axis [rad].
  double at(std::size_t axis) const { return angle[axis] + 2 * kPi * turns[axis]; }
};

/// The angle that differs from `angle` by whole turns and is nearest to `near` [rad].
inline double nearestTurn(double angle, double near) {
  const double turns = std::round((near - angle) / (2 * kPi));
  return turns == 0 ? angle : angle + 2 * kPi * turns;
}

/// Where everything in a world is, with the indices of the model.
struct State {
  std::vector<DynamicState> bodies;
  std::vector<JointState> joints;
  /// By joint, when a step begins: of hinges, universal joints, hinge2 and Euler motors. The plugin `physics` writes
  /// them.
  std::vector<JointCoordinates> coordinates;
  std::size_t turned = 0;      ///< number of joints with turns other than 0
  std::vector<Motors> motors;  ///< by joint
  std::vector<AxisControl> controls;
  std::vector<BlockInput> inputs;  ///< of blocks of the world, in the order in which they were set first
  /// For a step of an engine with Capabilities::laws: what acts on the joints of bodies that are awake. Those of one
  /// axis act beside each other. The plugin `physics` writes them.
  std::vector<AxisLaw> laws;
  /// By body: DynamicState::version when saved state was loaded. Empty: none was, or bodies were removed since.
  std::vector<std::uint32_t> loaded;
  /// The bodies whose pose changed since the last detect(), each once, in the order in which they did.
  std::vector<Index> moved;
  /// Appends a body to `moved`, once.
  void markMoved(Index body) {
    if (std::exchange(bodies[body].moved, true)) return;
    moved.push_back(body);
  }
};

}  // namespace spark::engine
