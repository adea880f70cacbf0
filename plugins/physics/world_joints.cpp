#include <Eigen/Geometry>
#include <algorithm>

#include "joint_frames.h"
#include "world_model.h"

// A joint is set in world coordinates, at the places that its bodies have then, and kept in the frames of the bodies.
// The frame of a missing body is the world frame.

namespace spark::physics {

using engine::Assembly;
using engine::axesOf;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointType;
using engine::kNone;

namespace {

bool hasAnchor(JointType type) {
  return type == JointType::ball || type == JointType::hinge || type == JointType::hinge2 ||
         type == JointType::universal;
}

}  // namespace

// ---- creation and bodies ----

JointHandle WorldModel::createJoint(JointType type) {
  Joint& j = model_.joints.emplace_back();
  model_.extensions.joints.emplace_back();
  state_.joints.emplace_back();
  state_.coordinates.emplace_back();
  state_.motors.emplace_back();
  motors_.emplace_back();
  angles_.emplace_back();
  controlAt_.push_back({kNone, kNone, kNone});
  j.id = nextId_++;
  j.type = type;
  const engine::WorldParameters& p = model_.parameters;
  for (engine::JointAxis& a : j.axes) {
    a.soft.cfm = a.soft.stopCfm = p.cfm;
    a.soft.stopErp = p.erp;
  }
  j.soft.erp = j.soft.suspensionErp = p.erp;
  j.soft.cfm = j.soft.suspensionCfm = p.cfm;
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
  startCoordinates(j);
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
  startCoordinates(j);
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
  startCoordinates(j);
  const int first = j.reversed ? 2 : 0, second = 2 - first;
  j.reference2 = toBody(stateAt(j.b), toWorld(stateAt(j.a), j.axisA[first]));
  j.reference1 = toBody(stateAt(j.a), toWorld(stateAt(j.b), j.axisA[second]));
}

/// The numbers that depend on the relative rotation of the bodies.
void WorldModel::setRelativeRotation(Joint& j) {
  startCoordinates(j);
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

}  // namespace spark::physics
