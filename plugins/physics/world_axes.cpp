#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>

#include "api/single_precision.h"
#include "joint_frames.h"
#include "world_model.h"

// What happens along the axes of joints: motors, controllers, stops, angles, rates and forces.

namespace spark::physics {

using engine::axesOf;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointParameter;
using engine::JointType;
using engine::kNone;

namespace {

bool isSoft(JointParameter p) { return p >= JointParameter::fudgeFactor && p <= JointParameter::suspensionCfm; }

/// A parameter of an axis, in the order of JointParameter. The first three are const, or none is.
template <class J, class S, class M>
auto* parameterOf(J& j, S& soft, M& motors, JointParameter p, int axis) {
  auto& a = j.axes[axis];
  auto& s = soft.axes[axis];
  auto& m = motors[axis];
  decltype(&a.lowStop) const all[] = {&a.lowStop,          &a.highStop, &m.velocity, &m.maxForce,   &s.fudgeFactor,
                                      &s.bounce,           &s.cfm,      &s.stopErp,  &s.stopCfm,    &soft.suspensionErp,
                                      &soft.suspensionCfm, &a.armature, &a.damping,  &a.dryFriction};
  return all[static_cast<int>(p)];
}

/// Suspension parameters belong to the first axis of hinge2.
bool hasParameter(const Joint& j, JointParameter p, int axis) {
  if (j.type == JointType::ball) return p == JointParameter::damping && axis == 0;
  const bool suspension = p == JointParameter::suspensionErp || p == JointParameter::suspensionCfm;
  return axis >= 0 && axis < axesOf(j.type) && (!suspension || (j.type == JointType::hinge2 && axis == 0));
}

}  // namespace

// ---- axes in the world ----

/// The three axes of an Euler motor, world frame. The middle one is perpendicular to the other two.
std::array<Vec3, 3> WorldModel::eulerAxes(const Joint& j) const {
  const std::size_t ofA = j.reversed ? 2 : 0, ofB = 2 - ofA;
  std::array<Vec3, 3> axes;
  axes[ofA] = toWorld(stateAt(j.a), j.inA.axis[ofA]);
  axes[ofB] = toWorld(stateAt(j.b), j.inB.axis[ofB]);
  axes[1] = axes[2].cross(axes[0]).normalized();
  return axes;
}

Vec3 WorldModel::worldAxis(const Joint& j, int axis) const {
  switch (j.type) {
    case JointType::universal:
      return (axis == 0) == j.reversed ? toWorld(stateAt(j.b), j.inB.axis[1]) : toWorld(stateAt(j.a), j.inA.axis[0]);
    case JointType::hinge2:
      return axis == 0 ? toWorld(stateAt(j.a), j.inA.axis[0]) : toWorld(stateAt(j.b), j.inB.axis[1]);
    case JointType::angularMotor: {
      if (j.motor.euler) return eulerAxes(j)[axis];
      const Index body = j.motor.frame[axis] == 1 ? j.a : j.motor.frame[axis] == 2 ? j.b : kNone;
      return toWorld(stateAt(body), (j.motor.frame[axis] == 2 ? j.inB : j.inA).axis[axis]);
    }
    default:
      return toWorld(stateAt(j.a), j.inA.axis[0]);
  }
}

// ---- motors and stops ----

void WorldModel::setParameter(JointHandle joint, JointParameter p, int axis, double wanted) {
  Joint& j = of(joint);
  if (!hasParameter(j, p, axis) || std::isnan(wanted)) return;
  // An infinite stop means that there is none.
  const bool noStop = std::isinf(wanted) && (p == JointParameter::lowStop || p == JointParameter::highStop);
  const double v = rounded(noStop ? wanted : bounded(wanted));
  if (p == JointParameter::maxForce && v < 0) return;
  if (p == JointParameter::fudgeFactor && (v < 0 || v > 1)) return;
  if (p >= JointParameter::armature && v < 0) return;
  damped_ |= p == JointParameter::damping && v > 0;
  const Index index = joints_[joint];
  engine::Blocks& scene = model_.extensions.sceneJoints[index];
  auto soft = isSoft(p) ? scene.get<engine::JointSoftness>() : engine::JointSoftness{};
  *parameterOf(j, soft, motors_[index], p, axis) = v;
  if (isSoft(p)) scene.set(engine::Block::of(soft));
  const bool motor = p == JointParameter::velocity || p == JointParameter::maxForce;
  if (motor)
    endControl(index, axis);
  else
    ++model_.dynamics;
  if ((motor || p == JointParameter::dryFriction) && axis < axesOf(j.type)) passMotor(index, axis);
}

void WorldModel::passMotor(Index joint, int axis) {
  engine::Motor& passed = state_.motors[joint][axis];
  passed = motors_[joint][axis];
  if (passed.maxForce > 0) return;  // in most calls; the joint's own numbers are far away
  if (const double friction = model_.joints[joint].axes[axis].dryFriction; friction > 0) passed = {0, friction};
}

double WorldModel::parameter(JointHandle joint, JointParameter p, int axis) const {
  const Joint& j = of(joint);
  if (!hasParameter(j, p, axis)) return 0;
  const Index index = joints_[joint];
  const auto soft =
      isSoft(p) ? model_.extensions.sceneJoints[index].get<engine::JointSoftness>() : engine::JointSoftness{};
  return *parameterOf(j, soft, motors_[index], p, axis);
}

void WorldModel::drive(JointHandle joint, int axis, double speed) {
  const Joint& j = of(joint);
  if (!hasParameter(j, JointParameter::velocity, axis) || std::isnan(speed)) return;
  const Index index = joints_[joint];
  motors_[index][axis].velocity = rounded(bounded(speed));
  endControl(index, axis);
  passMotor(index, axis);
  // Wake the first body of attach().
  if (speed == 0 || j.reversed || j.a == kNone || state_.bodies[j.a].awake) return;
  setEnabled(bodies_.handleOf(j.a), true);
}

void WorldModel::control(JointHandle joint, int axis, const engine::Control& wanted) {
  const Index index = joints_[joint];
  const Joint& j = model_.joints[index];
  const double numbers[] = {wanted.stiffness, wanted.damping, wanted.position, wanted.velocity, wanted.force};
  if (axis < 0 || axis >= axesOf(j.type) || !inRange(numbers, 5) || wanted.stiffness < 0 || wanted.damping < 0 ||
      !(wanted.maxForce >= 0))
    return;
  if (Index& at = controlAt_[index][axis]; at == kNone) {
    at = static_cast<Index>(state_.controls.size());
    state_.controls.push_back({index, axis, wanted});
  } else {
    state_.controls[at].control = wanted;
  }
  motors_[index][axis] = {};
  passMotor(index, axis);
  if (j.a != kNone && !state_.bodies[j.a].awake) setEnabled(bodies_.handleOf(j.a), true);
}

const engine::Control* WorldModel::controlOf(JointHandle joint, int axis) const {
  const Index at = controlAt_[joints_[joint]][axis];
  return at == kNone ? nullptr : &state_.controls[at].control;
}

void WorldModel::endControl(Index joint, int axis) {
  const Index at = controlAt_[joint][axis];
  if (at == kNone) return;
  state_.controls.erase(state_.controls.begin() + at);
  listControls();
}

/// Finds the place of each controller anew.
void WorldModel::listControls() {
  controlAt_.assign(model_.joints.size(), {kNone, kNone, kNone});
  for (Index i = 0; i < state_.controls.size(); ++i) controlAt_[state_.controls[i].joint][state_.controls[i].axis] = i;
}

namespace {

/// The sign of the rate of an axis' angle against the velocity of a relative to b about the axis.
double angleSign(const Joint& j, int axis) {
  if (j.type == JointType::hinge2) return axis == 1 ? -1 : 1;
  return j.reversed && !(j.type == JointType::universal && axis == 0) ? -1 : 1;
}

}  // namespace

/// Adds a force that increases the angle of an axis.
void WorldModel::addAlong(const Joint& j, int axis, double force) {
  const Vec3 along = angleSign(j, axis) * force * worldAxis(j, axis);
  DynamicState& a = state_.bodies[j.a];
  DynamicState* b = j.b == kNone ? nullptr : &state_.bodies[j.b];
  if (j.type != JointType::slider) {
    a.torque += along;
    if (b) b->torque -= along;
    return;
  }
  // Halfway between the centres: the pair gets no torque.
  const Vec3 arm = b ? Vec3(0.5 * (b->position - a.position)) : Vec3(Vec3::Zero());
  a.force += along;
  a.torque += arm.cross(along);
  if (!b) return;
  b->force -= along;
  b->torque += arm.cross(along);
}

bool WorldModel::acts(const Joint& j) const {
  return attached(j) && (state_.bodies[j.a].awake || (j.b != kNone && state_.bodies[j.b].awake));
}

double WorldModel::exactRate(Index joint, int axis) const {
  const Joint& j = model_.joints[joint];
  if (j.type == JointType::slider) return rateOf(joint, axis);
  return angleSign(j, axis) * worldAxis(j, axis).dot(angularVelocity(stateAt(j.a)) - angularVelocity(stateAt(j.b)));
}

void WorldModel::applyControls() {
  for (const engine::AxisControl& c : state_.controls)
    if (const Joint& j = model_.joints[c.joint]; acts(j))
      addAlong(j, c.axis, c.control.at(angleOf(c.joint, c.axis), exactRate(c.joint, c.axis)));
}

void WorldModel::applyDamping() {
  for (Index i = 0; i < model_.joints.size(); ++i) {
    const Joint& j = model_.joints[i];
    for (int axis = 0; axis < axesOf(j.type); ++axis)
      if (j.axes[axis].damping > 0 && acts(j)) addAlong(j, axis, -j.axes[axis].damping * exactRate(i, axis));
    if (j.type != JointType::ball || j.axes[0].damping == 0 || !acts(j)) continue;
    const Vec3 torque = j.axes[0].damping * (angularVelocity(stateAt(j.b)) - angularVelocity(stateAt(j.a)));
    state_.bodies[j.a].torque += torque;
    if (j.b != kNone) state_.bodies[j.b].torque -= torque;
  }
}

void WorldModel::applyBodyDamping(double dt) {
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  for (Index i = 0; i < model_.bodies.size(); ++i) {
    const engine::Body& b = model_.bodies[i];
    DynamicState& s = state_.bodies[i];
    if ((b.linearDamping == 0 && b.angularDamping == 0) || !s.awake) continue;
    const Vec3 arm = s.rotation * b.linkOrigin;
    Vec6 motion;
    motion << s.linearVelocity, s.angularVelocity;
    // The velocity at the origin of the link's frame is J times the motion.
    Eigen::Matrix<double, 3, 6> j;
    j << Mat3::Identity(), (Mat3() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0).finished();
    Mat6 damping = b.linearDamping * j.transpose() * j;
    damping.diagonal().tail<3>().array() += b.angularDamping;
    if (b.joints == 0) {
      Mat6 mass = Mat6::Zero();
      mass.diagonal().head<3>().setConstant(b.mass);
      mass.bottomRightCorner<3, 3>() = s.rotation * b.inertia * s.rotation.transpose();
      motion = (mass + dt * damping).ldlt().solve(mass * motion);
    }
    const Vec6 force = -damping * motion;
    s.force += force.head<3>();
    s.torque += force.tail<3>();
  }
}

void WorldModel::applySprings() {
  for (Index i = 0; i < model_.joints.size(); ++i)
    for (int axis = 0; axis < axesOf(model_.joints[i].type); ++axis)
      if (const Joint& j = model_.joints[i]; j.axes[axis].stiffness > 0 && acts(j))
        addAlong(j, axis, j.axes[axis].stiffness * (j.axes[axis].springPosition - angleOf(i, axis)));
}

void WorldModel::setSpring(JointHandle joint, int axis, double stiffness, double position) {
  Joint& j = of(joint);
  if (axis < 0 || axis >= axesOf(j.type) || !(stiffness >= 0) || !std::isfinite(position)) return;
  j.axes[axis].stiffness = bounded(stiffness);
  j.axes[axis].springPosition = position;
  sprung_ |= stiffness > 0;
  ++model_.dynamics;
}

bool WorldModel::atStop(JointHandle joint, int axis) const {
  const Joint& j = of(joint);
  if (axis < 0 || axis >= axesOf(j.type)) return false;
  const engine::JointAxis& a = j.axes[axis];
  const double angle = WorldModel::angle(joint, axis);
  if (!model_.exactReplay || j.type == JointType::slider) return angle <= a.lowStop || angle >= a.highStop;
  // Exact replay compares in degrees, rounded where the installed base rounds: a foot may rest at its stop for many
  // cycles, and the last bit decides whether its motor accepts commands (protocol, section 2.1).
  const double angleDeg = roundToFloat(radToDeg(angle));
  const auto stopDeg = [](double stop) { return stop * 180.0 / kPi; };
  return angleDeg <= stopDeg(a.lowStop) || angleDeg >= stopDeg(a.highStop);
}

// ---- angles and rates ----

double WorldModel::hingeAngle(Index joint) const {
  CachedAngle& cache = angles_[joint];
  const std::atomic_ref<double> angle(cache.angle);
  const std::atomic_ref<std::uint64_t> at(cache.at);
  if (at.load(std::memory_order_acquire) == poses_) return angle.load(std::memory_order_relaxed);
  const Joint& j = model_.joints[joint];
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Quaternion relative = b ? timesConjugate(conjugateTimes(a->quaternion, b->quaternion), j.inA.rotation)
                                : conjugateTimesConjugate(a->quaternion, j.inA.rotation);
  const double found = physics::hingeAngle(relative, j.inA.axis[0]);
  angle.store(found, std::memory_order_relaxed);
  at.store(poses_, std::memory_order_release);
  return found;
}

/// Half of a universal joint: the cross between its bodies turns about one axis relative to each.
double WorldModel::universalAngle(const Joint& j, int axis) const {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 first = times(a->rotation, j.inA.axis[0]), second = b ? times(b->rotation, j.inB.axis[1]) : j.inB.axis[1];
  if (axis == 0) {
    const Quaternion cross = quaternionOf(frameFromAxes(first, second));
    return physics::hingeAngle(timesConjugate(conjugateTimes(a->quaternion, cross), j.inA.rotation), j.inA.axis[0]);
  }
  const Quaternion cross = quaternionOf(frameFromAxes(second, first));
  return -physics::hingeAngle(timesConjugate(relativeTo(b, cross), j.inB.rotation), j.inB.axis[1]);
}

double WorldModel::hinge2Angle(const Joint& j, int axis) const {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  // The other axis, in the frame of the body that this one is fixed to.
  const Vec3 other = axis == 0 ? toBody(a, toWorld(b, j.inB.axis[1])) : toBody(b, toWorld(a, j.inA.axis[0]));
  const Vec3 &zero = axis == 0 ? j.inA.axis[1] : j.inB.axis[0], &third = axis == 0 ? j.inA.axis[2] : j.inB.axis[2];
  return -std::atan2(dot(third, other), dot(zero, other));
}

double WorldModel::eulerAngle(const Joint& j, int axis) const {
  const std::array<Vec3, 3> axes = eulerAxes(j);
  // Where axes 2 and 0 were when set, carried along by the other body: angles 0 and 2 are counted from there.
  const std::size_t ofA = j.reversed ? 2 : 0, ofB = 2 - ofA;
  std::array<Vec3, 3> zero;
  zero[ofA] = toWorld(stateAt(j.b), j.inB.axis[ofA]);
  zero[ofB] = toWorld(stateAt(j.a), j.inA.axis[ofB]);
  if (axis == 0) return -std::atan2(axes[2].dot(axes[0].cross(zero[2])), axes[2].dot(zero[2]));
  if (axis == 1) return -std::atan2(axes[2].dot(axes[0]), axes[2].dot(axes[0].cross(axes[1])));
  return -std::atan2(zero[0].dot(axes[1]), zero[0].dot(axes[1].cross(axes[2])));
}

double WorldModel::angleRate(JointHandle joint, int axis) const { return rateOf(joints_[joint], axis); }

double WorldModel::sliderPosition(const Joint& j) const {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 along = times(a->rotation, j.inA.axis[0]);
  const Vec3 offset =
      b ? Vec3(a->position - times(b->rotation, j.inB.anchor) - b->position) : a->position - j.inB.anchor;
  const double position = dot(along, offset);
  return !b && j.reversed ? -position : position;
}

double WorldModel::rawAngle(Index joint, int axis) const {
  const Joint& j = model_.joints[joint];
  switch (j.type) {
    case JointType::hinge:
      return hingeAngle(joint);
    case JointType::universal:
      return universalAngle(j, axis);
    case JointType::hinge2:
      return hinge2Angle(j, axis);
    default:
      return eulerAngle(j, axis);
  }
}

double WorldModel::rateOf(Index joint, int axis) const {
  const Joint& j = model_.joints[joint];
  if (axis < 0 || axis >= axesOf(j.type) || !attached(j)) return 0;
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  if (j.type == JointType::angularMotor && axis >= j.motor.axes) return 0;
  if (j.type == JointType::slider) {
    const Vec3 along = times(a->rotation, j.inA.axis[0]);
    const double rate =
        b ? dot(along, a->linearVelocity) - dot(along, b->linearVelocity) : dot(along, a->linearVelocity);
    return !b && j.reversed ? -rate : rate;
  }
  const Vec3 about = worldAxis(j, axis);
  const double rate = dot(about, angularVelocity(a)) - (b ? dot(about, angularVelocity(b)) : 0);
  return j.reversed ? -rate : rate;
}

// ---- feedback ----

void WorldModel::setFeedback(JointHandle joint, bool on) {
  of(joint).wantsFeedback = on;
  ++model_.dynamics;
  state_.joints[joints_[joint]] = {};
}

void WorldModel::feedback(JointHandle joint, Vec3& force1, Vec3& torque1, Vec3& force2, Vec3& torque2) const {
  const engine::JointState& s = state_.joints[joints_[joint]];
  force1 = s.forceA, torque1 = s.torqueA;
  force2 = s.forceB, torque2 = s.torqueB;
  if (!of(joint).reversed) return;
  std::swap(force1, force2);
  std::swap(torque1, torque2);
}

}  // namespace spark::physics
