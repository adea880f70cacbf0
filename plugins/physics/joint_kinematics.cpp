#include "joint_kinematics.h"

#include <Eigen/Geometry>
#include <atomic>

#include "joint_frames.h"

namespace spark::physics {

using engine::axesOf;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointType;
using engine::kNone;

bool hasAnchor(JointType type) {
  return type == JointType::ball || type == JointType::hinge || type == JointType::hinge2 ||
         type == JointType::universal;
}

/// The sign of the rate of an axis' angle against the velocity of a relative to b about the axis.
double angleSign(const Joint& j, int axis) {
  if (j.type == JointType::hinge2) return axis == 1 ? -1 : 1;
  return j.reversed && !(j.type == JointType::universal && axis == 0) ? -1 : 1;
}

// ---- axes in the world ----

/// The three axes of an Euler motor, world frame. The middle one is perpendicular to the other two.
std::array<Vec3, 3> JointKinematics::eulerAxes(const Joint& j) const {
  const std::size_t ofA = j.reversed ? 2 : 0, ofB = 2 - ofA;
  std::array<Vec3, 3> axes;
  axes[ofA] = toWorld(world_.stateAt(j.a), j.inA.axis[ofA]);
  axes[ofB] = toWorld(world_.stateAt(j.b), j.inB.axis[ofB]);
  axes[1] = axes[2].cross(axes[0]).normalized();
  return axes;
}

Vec3 JointKinematics::worldAxis(const Joint& j, int axis) const {
  switch (j.type) {
    case JointType::universal:
      return (axis == 0) == j.reversed ? toWorld(world_.stateAt(j.b), j.inB.axis[1])
                                       : toWorld(world_.stateAt(j.a), j.inA.axis[0]);
    case JointType::hinge2:
      return axis == 0 ? toWorld(world_.stateAt(j.a), j.inA.axis[0]) : toWorld(world_.stateAt(j.b), j.inB.axis[1]);
    case JointType::angularMotor: {
      if (j.motor.euler) return eulerAxes(j)[axis];
      const Index body = j.motor.frame[axis] == 1 ? j.a : j.motor.frame[axis] == 2 ? j.b : kNone;
      return toWorld(world_.stateAt(body), (j.motor.frame[axis] == 2 ? j.inB : j.inA).axis[axis]);
    }
    default:
      return toWorld(world_.stateAt(j.a), j.inA.axis[0]);
  }
}

Vec3 JointKinematics::anchor(Index joint) const {
  const Joint& j = model().joints[joint];
  return attached(j) && hasAnchor(j.type) ? pointToWorld(world_.stateAt(j.a), j.inA.anchor) : Vec3(Vec3::Zero());
}

Vec3 JointKinematics::axis(Index joint, int axis) const {
  const Joint& j = model().joints[joint];
  return axis >= 0 && axis < axesOf(j.type) && attached(j) ? worldAxis(j, axis) : Vec3(Vec3::Zero());
}

// ---- angles within one turn ----

bool JointKinematics::isCached(Index joint) const {
  return std::atomic_ref(cached_[joint].at).load(std::memory_order_acquire) == world_.poses;
}

JointKinematics::HingeAngle JointKinematics::hingeAngle(Index joint) const {
  CachedAngle& cache = cached_[joint];
  const std::atomic_ref ofPoses(cache.angle.ofPoses), continuous(cache.angle.continuous);
  if (isCached(joint)) return {ofPoses.load(std::memory_order_relaxed), continuous.load(std::memory_order_relaxed)};
  const Joint& j = model().joints[joint];
  const double raw = hingeAngleOf(*world_.stateAt(j.a), world_.stateAt(j.b), j.inA.rotation, j.inA.axis[0]);
  const double sign = viewOf(j, 0).sign;
  const HingeAngle found{sign * raw, viewed(sign, raw, turnsNow(joint, 0, raw))};
  ofPoses.store(found.ofPoses, std::memory_order_relaxed);
  continuous.store(found.continuous, std::memory_order_relaxed);
  std::atomic_ref(cache.at).store(world_.poses, std::memory_order_release);
  return found;
}

/// Half of a universal joint: the cross between its bodies turns about one axis relative to each.
double JointKinematics::universalAngle(const Joint& j, int axis) const {
  const DynamicState *a = world_.stateAt(j.a), *b = world_.stateAt(j.b);
  const Vec3 first = times(a->rotation, j.inA.axis[0]), second = b ? times(b->rotation, j.inB.axis[1]) : j.inB.axis[1];
  if (axis == 0) {
    const Quaternion cross = quaternionOf(frameFromAxes(first, second));
    return physics::hingeAngle(timesConjugate(conjugateTimes(a->quaternion, cross), j.inA.rotation), j.inA.axis[0]);
  }
  const Quaternion cross = quaternionOf(frameFromAxes(second, first));
  return -physics::hingeAngle(timesConjugate(relativeTo(b, cross), j.inB.rotation), j.inB.axis[1]);
}

double JointKinematics::hinge2Angle(const Joint& j, int axis) const {
  const DynamicState *a = world_.stateAt(j.a), *b = world_.stateAt(j.b);
  // The other axis, in the frame of the body that this one is fixed to.
  const Vec3 other = axis == 0 ? toBody(a, toWorld(b, j.inB.axis[1])) : toBody(b, toWorld(a, j.inA.axis[0]));
  const Vec3 &zero = axis == 0 ? j.inA.axis[1] : j.inB.axis[0], &third = axis == 0 ? j.inA.axis[2] : j.inB.axis[2];
  return -std::atan2(dot(third, other), dot(zero, other));
}

double JointKinematics::eulerAngle(const Joint& j, int axis) const {
  const std::array<Vec3, 3> axes = eulerAxes(j);
  // Where axes 2 and 0 were when set, carried along by the other body: angles 0 and 2 are counted from there.
  const std::size_t ofA = j.reversed ? 2 : 0, ofB = 2 - ofA;
  std::array<Vec3, 3> zero;
  zero[ofA] = toWorld(world_.stateAt(j.b), j.inB.axis[ofA]);
  zero[ofB] = toWorld(world_.stateAt(j.a), j.inA.axis[ofB]);
  if (axis == 0) return -std::atan2(axes[2].dot(axes[0].cross(zero[2])), axes[2].dot(zero[2]));
  if (axis == 1) return -std::atan2(axes[2].dot(axes[0]), axes[2].dot(axes[0].cross(axes[1])));
  return -std::atan2(zero[0].dot(axes[1]), zero[0].dot(axes[1].cross(axes[2])));
}

double JointKinematics::sliderPosition(const Joint& j) const {
  const DynamicState *a = world_.stateAt(j.a), *b = world_.stateAt(j.b);
  const Vec3 along = times(a->rotation, j.inA.axis[0]);
  const Vec3 offset =
      b ? Vec3(a->position - times(b->rotation, j.inB.anchor) - b->position) : a->position - j.inB.anchor;
  const double position = dot(along, offset);
  return !b && j.reversed ? -position : position;
}

double JointKinematics::rawAngle(Index joint, int axis) const {
  const Joint& j = model().joints[joint];
  switch (j.type) {
    case JointType::hinge:
      return viewOf(j, axis).sign * hingeAngle(joint).ofPoses;
    case JointType::universal:
      return universalAngle(j, axis);
    case JointType::hinge2:
      return hinge2Angle(j, axis);
    default:
      return eulerAngle(j, axis);
  }
}

double JointKinematics::rate(Index joint, int axis) const {
  const Joint& j = model().joints[joint];
  if (axis < 0 || axis >= axesOf(j.type) || !attached(j)) return 0;
  const DynamicState *a = world_.stateAt(j.a), *b = world_.stateAt(j.b);
  if (j.type == JointType::angularMotor && axis >= j.motor.axes) return 0;
  if (j.type == JointType::slider) {
    const Vec3 along = times(a->rotation, j.inA.axis[0]);
    double found = b ? dot(along, a->linearVelocity) - dot(along, b->linearVelocity) : dot(along, a->linearVelocity);
    // The rate of the installed base leaves out that the bodies turn.
    if (b && !model().exactReplay) found -= dot(along, a->angularVelocity.cross(a->position - b->position));
    return !b && j.reversed ? -found : found;
  }
  const Vec3 about = worldAxis(j, axis);
  const double found = dot(about, angularVelocity(a)) - (b ? dot(about, angularVelocity(b)) : 0);
  return j.reversed ? -found : found;
}

double JointKinematics::exactRate(Index joint, int axis) const {
  const Joint& j = model().joints[joint];
  if (j.type == JointType::slider) return rate(joint, axis);
  return angleSign(j, axis) *
         worldAxis(j, axis).dot(angularVelocity(world_.stateAt(j.a)) - angularVelocity(world_.stateAt(j.b)));
}

bool JointKinematics::atStop(Index joint, int axis) const {
  const Joint& j = model().joints[joint];
  if (axis < 0 || axis >= axesOf(j.type)) return false;
  const engine::JointAxis& a = j.axes[axis];
  const double angle = this->angle(joint, axis);
  if (!model().exactReplay || j.type == JointType::slider) return angle <= a.lowStop || angle >= a.highStop;
  // Exact replay compares in degrees, rounded where the installed base rounds: a foot may rest at its stop for many
  // cycles, and the last bit decides whether its motor accepts commands (protocol, section 2.1).
  const double angleDeg = roundToFloat(radToDeg(angle));
  const auto stopDeg = [](double stop) { return stop * 180.0 / kPi; };
  return angleDeg <= stopDeg(a.lowStop) || angleDeg >= stopDeg(a.highStop);
}

}  // namespace spark::physics
