#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>

#include "api/single_precision.h"
#include "world_model.h"

// A joint is set in world coordinates, at the places that its bodies have then, and kept in the frames of the bodies.
// The frame of a missing body is the world frame.

namespace spark::physics {

using engine::Assembly;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointParameter;
using engine::JointType;
using engine::kNone;

int axesOf(JointType type) {
  switch (type) {
    case JointType::hinge:
    case JointType::slider:
      return 1;
    case JointType::universal:
    case JointType::hinge2:
      return 2;
    case JointType::angularMotor:
      return 3;
    default:
      return 0;
  }
}

namespace {

// Directions and points between a body's frame and the world frame; nullptr: the world.

Vec3 toWorld(const DynamicState* b, const Vec3& direction) { return b ? Vec3(b->rotation * direction) : direction; }
Vec3 toBody(const DynamicState* b, const Vec3& direction) {
  return b ? Vec3(b->rotation.transpose() * direction) : direction;
}
Vec3 pointToWorld(const DynamicState* b, const Vec3& p) { return b ? Vec3(toWorld(b, p) + b->position) : p; }
Vec3 pointToBody(const DynamicState* b, const Vec3& p) { return b ? toBody(b, p - b->position) : p; }
Vec3 angularVelocity(const DynamicState* b) { return b ? b->angularVelocity : Vec3(Vec3::Zero()); }

/// The rotation `q`, given relative to the world, relative to a body.
Quaternion relativeTo(const DynamicState* b, const Quaternion& q) { return b ? conjugateTimes(b->quaternion, q) : q; }

/// The rotation of the second body relative to the first.
Quaternion relativeRotation(const DynamicState* a, const DynamicState* b) {
  return relativeTo(a, b ? b->quaternion : Quaternion{1, 0, 0, 0});
}

/// A parameter of an axis, in the order of JointParameter. `J` and `M` are const, or both are not.
template <class J, class M>
auto* parameterOf(J& j, M& motors, JointParameter p, int axis) {
  auto& a = j.axes[axis];
  auto& m = motors[axis];
  decltype(&a.lowStop)
      const all[] = {&a.lowStop,           &a.highStop, &m.velocity,    &m.maxForce,    &a.ode.fudgeFactor,
                     &a.ode.bounce,        &a.ode.cfm,  &a.ode.stopErp, &a.ode.stopCfm, &j.ode.suspensionErp,
                     &j.ode.suspensionCfm, &a.armature, &a.damping,     &a.dryFriction};
  return all[static_cast<int>(p)];
}

/// Suspension parameters belong to the first axis of hinge2.
bool hasParameter(const Joint& j, JointParameter p, int axis) {
  const bool suspension = p == JointParameter::suspensionErp || p == JointParameter::suspensionCfm;
  return axis >= 0 && axis < axesOf(j.type) && (!suspension || (j.type == JointType::hinge2 && axis == 0));
}

bool attached(const Joint& j) { return j.a != kNone; }

bool hasAnchor(JointType type) {
  return type == JointType::ball || type == JointType::hinge || type == JointType::hinge2 ||
         type == JointType::universal;
}

}  // namespace

// ---- creation and bodies ----

JointHandle WorldModel::createJoint(JointType type) {
  Joint& j = model_.joints.emplace_back();
  state_.joints.emplace_back();
  state_.motors.emplace_back();
  angles_.emplace_back();
  j.id = nextId_++;
  j.type = type;
  const engine::WorldParameters& p = model_.parameters;
  for (engine::JointAxis& a : j.axes) {
    a.ode.cfm = a.ode.stopCfm = p.cfm;
    a.ode.stopErp = p.erp;
  }
  j.ode.erp = j.ode.suspensionErp = p.erp;
  j.ode.cfm = j.ode.suspensionCfm = p.cfm;
  if (type == JointType::fixed) j.initialRotationA.fill(0);
  if (type != JointType::angularMotor) {
    j.axisA[0] = j.axisB[0] = j.planeA[0] = Vec3::UnitX();
    j.axisB[1] = j.planeA[1] = Vec3::UnitY();
  }
  ++model_.structure;
  return joints_.add();
}

void WorldModel::destroyJoint(JointHandle joint) {
  detach(of(joint));
  joints_.remove(joint);
  ++model_.structure;
  compactWhenMany();
}

/// Leaves the joint without bodies.
void WorldModel::detach(Joint& j) {
  if (j.a != kNone) --model_.bodies[j.a].joints;
  if (j.b != kNone) --model_.bodies[j.b].joints;
  j.a = j.b = kNone;
  j.attachedAt = ++attachments_;
  ++model_.structure;
}

void WorldModel::attach(JointHandle joint, BodyHandle a, BodyHandle b) {
  if (a == b && a != BodyHandle::none)
    throw Error("a joint cannot connect a body with itself: name two bodies, or one and the world");
  Joint& j = of(joint);
  if (j.type == JointType::hinge2 && (a == BodyHandle::none) != (b == BodyHandle::none))
    throw Error("a wheel's joint (hinge2) needs two bodies, found one: name the chassis and the wheel");
  detach(j);
  j.reversed = a == BodyHandle::none && b != BodyHandle::none;
  j.a = bodies_[j.reversed ? b : a];
  j.b = j.reversed ? kNone : bodies_[b];
  if (j.a != kNone) ++model_.bodies[j.a].joints;
  if (j.b != kNone) ++model_.bodies[j.b].joints;
  // A fixed joint and an angular motor keep all numbers.
  if (!attached(j) || j.type == JointType::fixed || j.type == JointType::angularMotor) return;

  // The others keep those in the frame of the first body, and compute the others from them.
  const DynamicState *first = stateAt(j.a), *second = stateAt(j.b);
  switch (j.type) {
    case JointType::slider:
      setSliderOffset(j);
      break;
    case JointType::hinge:
      j.axisB[0] = toBody(second, toWorld(first, j.axisA[0]));
      break;
    case JointType::hinge2:
      setHinge2Axes(j);
      break;
    default:
      break;
  }
  if (hasAnchor(j.type)) anchorSet(j, j.reversed ? j.anchorB : pointToWorld(first, j.anchorA));
  if (j.assembly.empty()) return;
  // The calls that would give the joint these numbers.
  j.assembly.clear();
  if (hasAnchor(j.type)) remember(j, Assembly::Kind::anchor, 0, pointToWorld(first, j.anchorA));
  for (int axis = 0; axis < axesOf(j.type); ++axis) remember(j, Assembly::Kind::axis, axis, worldAxis(j, axis));
}

/// Appends a call to the joint's assembly, in place of an earlier one of its kind.
Assembly& WorldModel::remember(Joint& j, Assembly::Kind kind, int axis, const Vec3& world) {
  const auto pose = [&](Index body) {
    if (body == kNone) return engine::AssemblyPose{Vec3::Zero(), {1, 0, 0, 0}, Mat3::Identity()};
    const DynamicState& s = state_.bodies[body];
    return engine::AssemblyPose{s.position, s.quaternion, s.rotation};
  };
  const bool single = kind == Assembly::Kind::anchor || kind == Assembly::Kind::motor || kind == Assembly::Kind::fixed;
  std::erase_if(j.assembly, [&](const Assembly& a) { return a.kind == kind && (single || a.axis == axis); });
  j.assembledAt = ++assemblies_;
  ++model_.dynamics;
  // The mode of a motor comes before its axes.
  const auto at = kind == Assembly::Kind::motor ? j.assembly.begin() : j.assembly.end();
  return *j.assembly.insert(at, Assembly{kind, axis, 0, world, pose(j.a), pose(j.b)});
}

// ---- anchor and axes ----

void WorldModel::setAnchor(JointHandle joint, const Vec3& wanted) {
  Joint& j = of(joint);
  if (!attached(j) || !hasAnchor(j.type) || !inRange(wanted)) return;
  const Vec3 p = rounded(wanted);
  remember(j, Assembly::Kind::anchor, 0, p);
  anchorSet(j, p);
}

void WorldModel::setAxis(JointHandle joint, int axis, const Vec3& world, int frame) {
  Joint& j = of(joint);
  if (axis < 0 || axis >= axesOf(j.type) || !attached(j)) return;
  const Vec3 v = rounded(world);
  if (!inRange(v) || v.norm() < 1e-9) throw Error("expected an axis longer than 0");
  if (j.type == JointType::angularMotor) {
    if ((frame == 1 && j.reversed) || (frame == 2 && j.b == kNone && !j.reversed) || frame < 0 || frame > 2)
      frame = 0;  // that body is the world
    if (axis >= j.motorAxes) return;
  }
  // Parallel axes of a hinge2 have no meaning: the other one is moved to a perpendicular direction, and the caller
  // usually sets it next.
  if (j.type == JointType::hinge2 && v.normalized().cross(worldAxis(j, 1 - axis)).norm() < 1e-9) {
    const Vec3 lateral = v.unitOrthogonal();
    remember(j, Assembly::Kind::axis, 1 - axis, lateral);
    (axis == 0 ? j.axisB[1] : j.axisA[0]) = toBody(stateAt(axis == 0 ? j.b : j.a), lateral);
  }
  remember(j, Assembly::Kind::axis, axis, v).frame = frame;
  axisSet(j, axis, v, frame);
}

void WorldModel::anchorSet(Joint& j, const Vec3& world) {
  ++poses_;
  j.anchorA = pointToBody(stateAt(j.a), world);
  j.anchorB = pointToBody(stateAt(j.b), world);
  setRelativeRotation(j);
}

void WorldModel::axisSet(Joint& j, int axis, const Vec3& world, int frame) {
  ++poses_;
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 direction = world.normalized();
  // ODE does not normalise an axis in the world frame.
  const Vec3 second = b ? toBody(b, direction) : world;
  switch (j.type) {
    case JointType::hinge:
      j.axisA[0] = toBody(a, direction);
      j.axisB[0] = second;
      break;
    case JointType::slider:
      j.axisA[0] = toBody(a, direction);
      return setSliderOffset(j);
    case JointType::universal:
      (axis == 0) == j.reversed ? j.axisB[1] = second : j.axisA[0] = toBody(a, direction);
      break;
    case JointType::hinge2:
      axis == 0 ? j.axisA[0] = toBody(a, direction) : j.axisB[1] = second;
      return setHinge2Axes(j);
    case JointType::angularMotor:
      if (frame != 0 && j.reversed) frame = 3 - frame;
      j.frame[axis] = frame;
      j.axisA[axis] = toBody(frame == 1 ? a : frame == 2 ? b : nullptr, world).normalized();
      if (j.euler) setEulerReferences(j);
      return;
    default:
      break;
  }
  setRelativeRotation(j);
}

/// Universal joint: the frames of the two axes, relative to each body.
void WorldModel::setUniversalFrames(Joint& j) {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 first = toWorld(a, j.axisA[0]), second = toWorld(b, j.axisB[1]);
  j.initialRotationA = relativeTo(a, quaternionOf(frameFromAxes(first, second)));
  j.initialRotationB = relativeTo(b, quaternionOf(frameFromAxes(second, first)));
}

/// Hinge2: the zero direction of each angle is the other axis, made perpendicular to its own.
void WorldModel::setHinge2Planes(Joint& j) {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 first = toWorld(a, j.axisA[0]), second = toWorld(b, j.axisB[1]);
  const Vec3 fromFirst = (second - first.dot(second) * first).normalized(),
             fromSecond = (first - first.dot(second) * second).normalized();
  j.planeA[0] = toBody(a, fromFirst);
  j.planeA[1] = toBody(a, first.cross(fromFirst));
  j.planeB[0] = toBody(b, fromSecond);
  j.planeB[1] = toBody(b, second.cross(fromSecond));
}

/// Hinge2: the angle between the axes, and the zero directions.
void WorldModel::setHinge2Axes(Joint& j) {
  const Vec3 first = toWorld(stateAt(j.a), j.axisA[0]), second = toWorld(stateAt(j.b), j.axisB[1]);
  j.sinAxes = first.cross(second).norm();
  j.cosAxes = first.dot(second);
  setHinge2Planes(j);
}

void WorldModel::setSliderOffset(Joint& j) {
  j.anchorB = pointToBody(stateAt(j.b), stateAt(j.a)->position);
  j.initialRotationA = relativeRotation(stateAt(j.a), stateAt(j.b));
}

/// Euler motor: the zero direction of each angle is the other body's axis.
void WorldModel::setEulerReferences(Joint& j) {
  if (!attached(j)) return;
  const int first = j.reversed ? 2 : 0, second = 2 - first;
  j.reference2 = toBody(stateAt(j.b), toWorld(stateAt(j.a), j.axisA[first]));
  j.reference1 = toBody(stateAt(j.a), toWorld(stateAt(j.b), j.axisA[second]));
}

/// The numbers that depend on the relative rotation of the bodies.
void WorldModel::setRelativeRotation(Joint& j) {
  switch (j.type) {
    case JointType::hinge:
      j.initialRotationA = relativeRotation(stateAt(j.a), stateAt(j.b));
      break;
    case JointType::universal:
      setUniversalFrames(j);
      break;
    case JointType::hinge2:
      setHinge2Planes(j);
      break;
    default:
      break;
  }
}

void WorldModel::setFixed(JointHandle joint) {
  Joint& j = of(joint);
  if (j.type != JointType::fixed || !attached(j)) return;
  remember(j, Assembly::Kind::fixed, 0, Vec3::Zero());
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  j.anchorA = b ? pointToBody(a, b->position) : Vec3(Vec3::Zero());
  j.anchorB = b ? Vec3(Vec3::Zero()) : a->position;
  j.initialRotationA = relativeRotation(a, b);
}

void WorldModel::setAngularMotor(JointHandle joint, int axes, bool euler) {
  Joint& j = of(joint);
  if (j.type != JointType::angularMotor) return;
  if (axes < 0 || axes > 3) throw Error(fmt::format("expected 0 to 3 axes of an angular motor, found {}", axes));
  j.euler = euler;
  j.motorAxes = euler ? 3 : axes;
  if (euler) setEulerReferences(j);
  Assembly& call = remember(j, Assembly::Kind::motor, j.motorAxes, Vec3::Zero());
  call.frame = euler;
}

void WorldModel::setMotorAngle(JointHandle joint, int axis, double angle) {
  Joint& j = of(joint);
  if (j.type != JointType::angularMotor || j.euler || axis < 0 || axis >= 3 || !std::isfinite(angle)) return;
  j.userAngle[axis] = angle;
  remember(j, Assembly::Kind::angle, axis, Vec3(angle, 0, 0));
}

Vec3 WorldModel::anchor(JointHandle joint) const {
  const Joint& j = of(joint);
  return attached(j) && hasAnchor(j.type) ? pointToWorld(stateAt(j.a), j.anchorA) : Vec3(Vec3::Zero());
}

Vec3 WorldModel::axis(JointHandle joint, int axis) const {
  const Joint& j = of(joint);
  return axis >= 0 && axis < axesOf(j.type) && attached(j) ? worldAxis(j, axis) : Vec3(Vec3::Zero());
}

/// The three axes of an Euler motor, world frame. The middle one is perpendicular to the other two.
std::array<Vec3, 3> WorldModel::eulerAxes(const Joint& j) const {
  const std::size_t ofA = j.reversed ? 2 : 0, ofB = 2 - ofA;
  std::array<Vec3, 3> axes;
  axes[ofA] = toWorld(stateAt(j.a), j.axisA[ofA]);
  axes[ofB] = toWorld(stateAt(j.b), j.axisA[ofB]);
  axes[1] = axes[2].cross(axes[0]).normalized();
  return axes;
}

Vec3 WorldModel::worldAxis(const Joint& j, int axis) const {
  switch (j.type) {
    case JointType::universal:
      return (axis == 0) == j.reversed ? toWorld(stateAt(j.b), j.axisB[1]) : toWorld(stateAt(j.a), j.axisA[0]);
    case JointType::hinge2:
      return axis == 0 ? toWorld(stateAt(j.a), j.axisA[0]) : toWorld(stateAt(j.b), j.axisB[1]);
    case JointType::angularMotor: {
      if (j.euler) return eulerAxes(j)[axis];
      const Index body = j.frame[axis] == 1 ? j.a : j.frame[axis] == 2 ? j.b : kNone;
      return toWorld(stateAt(body), j.axisA[axis]);
    }
    default:
      return toWorld(stateAt(j.a), j.axisA[0]);
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
  *parameterOf(j, state_.motors[joints_[joint]], p, axis) = v;
  if (p != JointParameter::velocity && p != JointParameter::maxForce) ++model_.dynamics;
}

double WorldModel::parameter(JointHandle joint, JointParameter p, int axis) const {
  const Joint& j = of(joint);
  return hasParameter(j, p, axis) ? *parameterOf(j, state_.motors[joints_[joint]], p, axis) : 0;
}

void WorldModel::drive(JointHandle joint, int axis, double speed) {
  const Joint& j = of(joint);
  if (!hasParameter(j, JointParameter::velocity, axis) || std::isnan(speed)) return;
  state_.motors[joints_[joint]][axis].velocity = rounded(bounded(speed));
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
  const auto isIt = [&](const engine::AxisControl& c) { return c.joint == index && c.axis == axis; };
  auto found = std::find_if(state_.controls.begin(), state_.controls.end(), isIt);
  if (found == state_.controls.end()) {
    state_.controls.push_back({index, axis, {}});
    found = std::prev(state_.controls.end());
  }
  found->control = wanted;
  // In place of the motor there is dry friction.
  state_.motors[index][axis] = {0, j.axes[axis].dryFriction};
  if (j.a != kNone && !state_.bodies[j.a].awake) setEnabled(bodies_.handleOf(j.a), true);
}

const engine::Control* WorldModel::controlOf(JointHandle joint, int axis) const {
  for (const engine::AxisControl& c : state_.controls)
    if (c.joint == joints_[joint] && c.axis == axis) return &c.control;
  return nullptr;
}

void WorldModel::removeControl(JointHandle joint, int axis) {
  std::erase_if(state_.controls,
                [&](const engine::AxisControl& c) { return c.joint == joints_[joint] && c.axis == axis; });
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

void WorldModel::applyControls() {
  // Forces on what sleeps would pile up.
  const auto acts = [&](const Joint& j) {
    return attached(j) && (state_.bodies[j.a].awake || (j.b != kNone && state_.bodies[j.b].awake));
  };
  const auto rate = [&](Index joint, int axis) {
    const Joint& j = model_.joints[joint];
    if (j.type == JointType::slider) return rateOf(joint, axis);
    return angleSign(j, axis) * worldAxis(j, axis).dot(angularVelocity(stateAt(j.a)) - angularVelocity(stateAt(j.b)));
  };
  for (const engine::AxisControl& c : state_.controls)
    if (const Joint& j = model_.joints[c.joint]; acts(j))
      addAlong(j, c.axis, c.control.at(angleOf(c.joint, c.axis), rate(c.joint, c.axis)));
  if (!damped_) return;
  for (Index i = 0; i < model_.joints.size(); ++i)
    for (int axis = 0; axis < axesOf(model_.joints[i].type); ++axis)
      if (const Joint& j = model_.joints[i]; j.axes[axis].damping > 0 && acts(j))
        addAlong(j, axis, -j.axes[axis].damping * rate(i, axis));
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
  const Quaternion relative = b ? timesConjugate(conjugateTimes(a->quaternion, b->quaternion), j.initialRotationA)
                                : conjugateTimesConjugate(a->quaternion, j.initialRotationA);
  const double found =
      j.reversed ? -physics::hingeAngle(relative, j.axisA[0]) : physics::hingeAngle(relative, j.axisA[0]);
  angle.store(found, std::memory_order_relaxed);
  at.store(poses_, std::memory_order_release);
  return found;
}

/// Half of a universal joint: the cross between its bodies turns about one axis relative to each.
double WorldModel::universalAngle(const Joint& j, int axis) const {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 first = times(a->rotation, j.axisA[0]), second = b ? times(b->rotation, j.axisB[1]) : j.axisB[1];
  if (axis == 0) {
    const Quaternion cross = quaternionOf(frameFromAxes(first, second));
    return physics::hingeAngle(timesConjugate(conjugateTimes(a->quaternion, cross), j.initialRotationA), j.axisA[0]);
  }
  const Quaternion cross = quaternionOf(frameFromAxes(second, first));
  return -physics::hingeAngle(timesConjugate(relativeTo(b, cross), j.initialRotationB), j.axisB[1]);
}

double WorldModel::hinge2Angle(const Joint& j, int axis) const {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  // The other axis, in the frame of the body that this one is fixed to.
  const Vec3 other = axis == 0 ? toBody(a, toWorld(b, j.axisB[1])) : toBody(b, toWorld(a, j.axisA[0]));
  const std::array<Vec3, 2>& plane = axis == 0 ? j.planeA : j.planeB;
  return -std::atan2(dot(plane[1], other), dot(plane[0], other));
}

double WorldModel::eulerAngle(const Joint& j, int axis) const {
  const std::array<Vec3, 3> axes = eulerAxes(j);
  // Where axes 2 and 0 were when set, carried along by the other body: angles 0 and 2 are counted from there.
  Vec3 zero2 = toWorld(stateAt(j.a), j.reference1), zero0 = toWorld(stateAt(j.b), j.reference2);
  if (j.reversed) std::swap(zero2, zero0);
  if (axis == 0) return -std::atan2(axes[2].dot(axes[0].cross(zero2)), axes[2].dot(zero2));
  if (axis == 1) return -std::atan2(axes[2].dot(axes[0]), axes[2].dot(axes[0].cross(axes[1])));
  return -std::atan2(zero0.dot(axes[1]), zero0.dot(axes[1].cross(axes[2])));
}

double WorldModel::angle(JointHandle joint, int axis) const { return angleOf(joints_[joint], axis); }

double WorldModel::angleRate(JointHandle joint, int axis) const { return rateOf(joints_[joint], axis); }

double WorldModel::angleOf(Index joint, int axis) const {
  const Joint& j = model_.joints[joint];
  if (axis < 0 || axis >= axesOf(j.type) || !attached(j)) return 0;
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  switch (j.type) {
    case JointType::hinge:
      return hingeAngle(joint);
    case JointType::slider: {
      const Vec3 along = times(a->rotation, j.axisA[0]);
      const Vec3 offset = b ? Vec3(a->position - times(b->rotation, j.anchorB) - b->position) : a->position - j.anchorB;
      const double position = dot(along, offset);
      return !b && j.reversed ? -position : position;
    }
    case JointType::universal:
      if (!j.reversed) return universalAngle(j, axis);
      return axis == 0 ? universalAngle(j, 1) : -universalAngle(j, 0);
    case JointType::hinge2:
      return hinge2Angle(j, axis);
    default:
      return axis >= j.motorAxes ? 0 : j.euler ? eulerAngle(j, axis) : j.userAngle[axis];
  }
}

double WorldModel::rateOf(Index joint, int axis) const {
  const Joint& j = model_.joints[joint];
  if (axis < 0 || axis >= axesOf(j.type) || !attached(j)) return 0;
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  if (j.type == JointType::angularMotor && axis >= j.motorAxes) return 0;
  if (j.type == JointType::slider) {
    const Vec3 along = times(a->rotation, j.axisA[0]);
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
