#include <utility>

#include "joint_frames.h"
#include "joint_kinematics.h"

// Turns of joints. The poses of two bodies say where a joint's axis is within one turn; how often it has turned is
// counted here, after each step of the engine: an angle that jumps by more than half a turn has passed +-pi. So stops,
// controllers and percepts work on one continuous number, the coordinate.
//
//     poses     ... 2.9   3.1  -3.0  -2.8 ...
//     turns          0     0     1     1
//     coordinate    2.9   3.1   3.28  3.48
//
// A pose that is set between two steps changes the coordinate by at most half a turn. Setting a joint's bodies, anchor
// or axes starts again at the angle of the poses.

namespace spark::physics {

using engine::axesOf;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointCoordinates;
using engine::JointType;
using engine::kNone;

namespace {

/// The number of axes that count turns.
int turningAxes(const Joint& j) {
  switch (j.type) {
    case JointType::hinge:
    case JointType::universal:
    case JointType::hinge2:
      return axesOf(j.type);
    case JointType::angularMotor:
      return j.motor.euler ? j.motor.axes : 0;
    default:
      return 0;
  }
}

/// The turns of an angle that was `before`, with its turns, and is `now`.
std::int32_t turnsAfter(double before, std::int32_t turns, double now) {
  const double change = now - before;
  return change > kPi ? turns - 1 : change < -kPi ? turns + 1 : turns;
}

bool isTurned(const JointCoordinates& c) { return c.turns != std::array<std::int32_t, 3>{}; }

}  // namespace

void JointKinematics::add() {
  state().coordinates.emplace_back();
  cached_.emplace_back();
}

void JointKinematics::renumber(const std::vector<Index>& now) {
  physics::renumber(state().coordinates, now);
  physics::renumber(cached_, now);
}

void JointKinematics::restart(Index joint) {
  JointCoordinates& c = state().coordinates[joint];
  state().turned -= isTurned(c);
  c = {};
  cached_[joint].at = 0;
  turningAt_ = 0;
}

void JointKinematics::setTurns(JointCoordinates& c, int axis, std::int32_t turns) {
  state().turned -= isTurned(c);
  c.turns[axis] = turns;
  state().turned += isTurned(c);
}

void JointKinematics::listTurning() {
  turning_.clear();
  state().turned = 0;
  for (Index i = 0; i < model().joints.size(); ++i) {
    state().turned += isTurned(state().coordinates[i]);
    if (const Joint& j = model().joints[i]; attached(j) && turningAxes(j) > 0)
      turning_.push_back({.joint = i,
                          .a = j.a,
                          .b = j.b,
                          .axes = turningAxes(j),
                          .hinge = j.type == JointType::hinge ? viewOf(j, 0).sign : 0,
                          .rotation = j.inA.rotation,
                          .axis = j.inA.axis[0]});
  }
  turningAt_ = model().structure;
  countedAt_ = 0;
}

void JointKinematics::begin() {
  if (turningAt_ != model().structure) listTurning();
  if (countedAt_ != world_.poses) count(false);
}

void JointKinematics::countTurns() { count(true); }

void JointKinematics::count(bool stepped) {
  for (Turning& t : turning_) {
    const DynamicState &a = state().bodies[t.a], *b = world_.stateAt(t.b);
    const std::uint32_t versionA = std::exchange(t.versionA, a.version),
                        versionB = std::exchange(t.versionB, b ? b->version : 0);
    CachedAngle& cache = cached_[t.joint];
    if (versionA != t.versionA || versionB != t.versionB)
      t.due = true;
    else if (cache.at == countedAt_)
      cache.at = world_.poses;  // nothing moved: what was known of it is still true
    if (!(a.awake || (b && b->awake)) || !(t.due || stepped)) continue;
    t.due = false;
    JointCoordinates& c = state().coordinates[t.joint];
    for (int axis = 0; axis < t.axes; ++axis) {
      const double now = t.hinge != 0 ? hingeAngleOf(a, b, t.rotation, t.axis) : rawAngle(t.joint, axis);
      const std::int32_t turns = turnsAfter(c.angle[axis], c.turns[axis], now);
      c.angle[axis] = now;
      if (turns != c.turns[axis]) setTurns(c, axis, turns);
      if (t.hinge != 0) cache = {{t.hinge * now, viewed(t.hinge, now, turns)}, world_.poses};
    }
  }
  countedAt_ = world_.poses;
}

std::int32_t JointKinematics::turnsNow(Index joint, int axis, double raw) const {
  const JointCoordinates& c = state().coordinates[joint];
  return turnsAfter(c.angle[axis], c.turns[axis], raw);
}

JointKinematics::AxisView JointKinematics::viewOf(const Joint& j, int axis) const {
  if (!j.reversed) return {axis, 1};
  if (j.type == JointType::hinge) return {axis, -1};
  if (j.type == JointType::universal) return axis == 0 ? AxisView{1, 1} : AxisView{0, -1};
  return {axis, 1};
}

double JointKinematics::angle(Index joint, int axis) const {
  if (axis == 0 && isCached(joint)) return hingeAngle(joint).continuous;
  const Joint& j = model().joints[joint];
  if (axis < 0 || axis >= axesOf(j.type) || !attached(j)) return 0;
  if (j.type == JointType::hinge) return hingeAngle(joint).continuous;
  if (j.type == JointType::slider) return sliderPosition(j);
  if (axis >= turningAxes(j)) return axis < j.motor.axes ? j.motor.angle[axis] : 0;
  const AxisView view = viewOf(j, axis);
  const double raw = rawAngle(joint, view.axis);
  return viewed(view.sign, raw, turnsNow(joint, view.axis, raw));
}

double JointKinematics::angleOfPoses(Index joint, int axis) const {
  if (axis == 0 && isCached(joint)) return hingeAngle(joint).ofPoses;
  const Joint& j = model().joints[joint];
  if (axis < 0 || axis >= turningAxes(j) || !attached(j)) return angle(joint, axis);
  const AxisView view = viewOf(j, axis);
  return view.sign * rawAngle(joint, view.axis);
}

double JointKinematics::coordinate(Index joint, int axis) const {
  const Joint& j = model().joints[joint];
  if (axis < 0 || axis >= turningAxes(j) || !attached(j)) return 0;
  const double raw = rawAngle(joint, axis);
  return raw + 2 * kPi * turnsNow(joint, axis, raw);
}

void JointKinematics::load(Index joint, int axis, double angle) {
  // Far from +-pi turns are certain; near it the poses that are restored too decide.
  if (axis < 0 || axis >= turningAxes(model().joints[joint]) || !(std::abs(angle) < 1e9)) return;
  JointCoordinates& c = state().coordinates[joint];
  setTurns(c, axis, static_cast<std::int32_t>(std::round(angle / (2 * kPi))));
  c.angle[axis] = angle - 2 * kPi * c.turns[axis];
  cached_[joint].at = 0;
  turningAt_ = 0;
}

}  // namespace spark::physics
