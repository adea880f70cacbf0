#include <Eigen/Geometry>
#include <algorithm>

#include "joint_frames.h"
#include "world_model.h"

// A joint is set in world coordinates, at the places that its bodies have then, and kept in the frames of the bodies.
// The frame of a missing body is the world frame.

namespace spark::physics {

using engine::axesOf;
using engine::Block;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointCall;
using engine::JointType;
using engine::kNone;

// ---- creation and bodies ----

JointHandle WorldModel::createJoint(JointType type) {
  Joint& j = model_.joints.emplace_back();
  model_.extensions.joints.emplace_back();
  state_.joints.emplace_back();
  state_.motors.emplace_back();
  motors_.emplace_back();
  kinematics_.add();
  controlAt_.push_back({kNone, kNone, kNone});
  j.id = nextId_++;
  j.type = type;
  const engine::WorldParameters& p = model_.parameters;
  engine::JointSoftness soft{{}, p.erp, p.cfm, p.erp, p.cfm};
  soft.axes.fill({.cfm = p.cfm, .stopErp = p.erp, .stopCfm = p.cfm});
  model_.extensions.sceneJoints.emplace_back().set(engine::Block::of(soft));
  if (type == JointType::fixed) j.inA.rotation.fill(0);
  if (type != JointType::angularMotor) {
    j.inA.axis[0] = j.inB.axis[0] = j.inA.axis[1] = Vec3::UnitX();
    j.inB.axis[1] = j.inA.axis[2] = Vec3::UnitY();
  }
  ++model_.structure;
  return joints_.add();
}

void WorldModel::destroyJoint(JointHandle joint) {
  detach(joints_[joint]);
  joints_.remove(joint);
  ++model_.structure;
  compactWhenMany();
}

/// Leaves the joint without bodies.
void WorldModel::detach(Index joint) {
  Joint& j = model_.joints[joint];
  rouse(j);
  if (j.a != kNone) --model_.bodies[j.a].joints;
  if (j.b != kNone) --model_.bodies[j.b].joints;
  j.a = j.b = kNone;
  kinematics_.restart(joint);
  j.attachedAt = ++attachments_;
  ++model_.structure;
}

void WorldModel::rouse(const Joint& joint) {
  if (joint.a != kNone) watch_.rouse(joint.a);
  if (joint.b != kNone) watch_.rouse(joint.b);
}

void WorldModel::attach(JointHandle joint, BodyHandle a, BodyHandle b) {
  if (a == b && a != BodyHandle::none)
    throw Error("a joint cannot connect a body with itself: name two bodies, or one and the world");
  Joint& j = of(joint);
  if (j.type == JointType::hinge2 && (a == BodyHandle::none) != (b == BodyHandle::none))
    throw Error("a wheel's joint (hinge2) needs two bodies, found one: name the chassis and the wheel");
  detach(joints_[joint]);
  j.reversed = a == BodyHandle::none && b != BodyHandle::none;
  j.a = bodies_[j.reversed ? b : a];
  j.b = j.reversed ? kNone : bodies_[b];
  if (j.a != kNone) ++model_.bodies[j.a].joints;
  if (j.b != kNone) ++model_.bodies[j.b].joints;
  rouse(j);
  // A fixed joint and an angular motor keep all numbers.
  if (!attached(j) || j.type == JointType::fixed || j.type == JointType::angularMotor) return;

  // The others keep those in the frame of the first body, and compute the others from them.
  const DynamicState *first = stateAt(j.a), *second = stateAt(j.b);
  switch (j.type) {
    case JointType::slider:
      setSliderOffset(j);
      break;
    case JointType::hinge:
      j.inB.axis[0] = toBody(second, toWorld(first, j.inA.axis[0]));
      break;
    case JointType::hinge2:
      setHinge2Axes(j);
      break;
    default:
      break;
  }
  if (hasAnchor(j.type)) anchorSet(j, j.reversed ? j.inB.anchor : pointToWorld(first, j.inA.anchor));
  if (j.setAt == 0) return;
  // The calls that would give the joint these numbers.
  for (int number = 0; model_.exactReplay && number < JointCall::kNumbers; ++number)
    model_.extensions.sceneJoints[joints_[joint]].remove(Block::kindOf<JointCall>(number));
  if (hasAnchor(j.type)) remember(j, JointCall::anchor, 0, pointToWorld(first, j.inA.anchor));
  for (int axis = 0; axis < axesOf(j.type); ++axis)
    remember(j, JointCall::setAxis, axis, kinematics_.worldAxis(j, axis));
}

/// Notes that a joint was set, and how, for engines that repeat the calls in exact replay.
void WorldModel::remember(Joint& j, JointCall::Kind kind, int axis, const Vec3& world, int frame) {
  j.setAt = ++settings_;
  ++model_.dynamics;
  rouse(j);
  if (!model_.exactReplay) return;
  const auto place = [&](Index body) {
    JointCall::Place p;
    if (body == kNone) return p;
    const DynamicState& s = state_.bodies[body];
    std::copy_n(s.position.data(), 3, p.position.begin());
    p.quaternion = s.quaternion;
    std::copy_n(s.rotation.data(), 9, p.rotation.begin());
    return p;
  };
  const JointCall call{kind, axis, frame, {world.x(), world.y(), world.z()}, place(j.a), place(j.b)};
  model_.extensions.sceneJoints[indexOf(j)].set(Block::of(call, call.numberOf()));
}

// ---- anchor and axes ----

void WorldModel::setAnchor(JointHandle joint, const Vec3& wanted) {
  Joint& j = of(joint);
  if (!attached(j) || !hasAnchor(j.type) || !inRange(wanted)) return;
  const Vec3 p = rounded(wanted);
  remember(j, JointCall::anchor, 0, p);
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
    if (axis >= j.motor.axes) return;
  }
  // Parallel axes of a hinge2 have no meaning: the other one is moved to a perpendicular direction, and the caller
  // usually sets it next.
  if (j.type == JointType::hinge2 && v.normalized().cross(kinematics_.worldAxis(j, 1 - axis)).norm() < 1e-9) {
    const Vec3 lateral = v.unitOrthogonal();
    remember(j, JointCall::setAxis, 1 - axis, lateral);
    (axis == 0 ? j.inB.axis[1] : j.inA.axis[0]) = toBody(stateAt(axis == 0 ? j.b : j.a), lateral);
  }
  remember(j, JointCall::setAxis, axis, v, frame);
  axisSet(j, axis, v, frame);
}

void WorldModel::anchorSet(Joint& j, const Vec3& world) {
  ++data_.poses;
  j.inA.anchor = pointToBody(stateAt(j.a), world);
  j.inB.anchor = pointToBody(stateAt(j.b), world);
  setRelativeRotation(j);
}

void WorldModel::axisSet(Joint& j, int axis, const Vec3& world, int frame) {
  ++data_.poses;
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 direction = world.normalized();
  // ODE does not normalise an axis in the world frame.
  const Vec3 second = b ? toBody(b, direction) : world;
  switch (j.type) {
    case JointType::hinge:
      j.inA.axis[0] = toBody(a, direction);
      j.inB.axis[0] = second;
      break;
    case JointType::slider:
      j.inA.axis[0] = toBody(a, direction);
      return setSliderOffset(j);
    case JointType::universal:
      (axis == 0) == j.reversed ? j.inB.axis[1] = second : j.inA.axis[0] = toBody(a, direction);
      break;
    case JointType::hinge2:
      axis == 0 ? j.inA.axis[0] = toBody(a, direction) : j.inB.axis[1] = second;
      return setHinge2Axes(j);
    case JointType::angularMotor:
      if (frame != 0 && j.reversed) frame = 3 - frame;
      j.motor.frame[axis] = frame;
      j.inA.axis[axis] = j.inB.axis[axis] = toBody(frame == 1 ? a : frame == 2 ? b : nullptr, world).normalized();
      if (j.motor.euler) setEulerReferences(j);
      return;
    default:
      break;
  }
  setRelativeRotation(j);
}

/// Universal joint: the frames of the two axes, relative to each body.
void WorldModel::setUniversalFrames(Joint& j) {
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 first = toWorld(a, j.inA.axis[0]), second = toWorld(b, j.inB.axis[1]);
  j.inA.rotation = relativeTo(a, quaternionOf(frameFromAxes(first, second)));
  j.inB.rotation = relativeTo(b, quaternionOf(frameFromAxes(second, first)));
}

/// Hinge2: the zero direction of each angle is the other axis, made perpendicular to its own.
void WorldModel::setHinge2Planes(Joint& j) {
  restart(j);
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  const Vec3 first = toWorld(a, j.inA.axis[0]), second = toWorld(b, j.inB.axis[1]);
  const Vec3 fromFirst = (second - first.dot(second) * first).normalized(),
             fromSecond = (first - first.dot(second) * second).normalized();
  j.inA.axis[1] = toBody(a, fromFirst);
  j.inA.axis[2] = toBody(a, first.cross(fromFirst));
  j.inB.axis[0] = toBody(b, fromSecond);
  j.inB.axis[2] = toBody(b, second.cross(fromSecond));
}

/// Hinge2: the angle between the axes, and the zero directions.
void WorldModel::setHinge2Axes(Joint& j) {
  const Vec3 first = toWorld(stateAt(j.a), j.inA.axis[0]), second = toWorld(stateAt(j.b), j.inB.axis[1]);
  j.sinAxes = first.cross(second).norm();
  j.cosAxes = first.dot(second);
  setHinge2Planes(j);
}

void WorldModel::setSliderOffset(Joint& j) {
  j.inB.anchor = pointToBody(stateAt(j.b), stateAt(j.a)->position);
  j.inA.rotation = relativeRotation(stateAt(j.a), stateAt(j.b));
}

/// Euler motor: the zero direction of each angle is the other body's axis.
void WorldModel::setEulerReferences(Joint& j) {
  if (!attached(j)) return;
  restart(j);
  const int first = j.reversed ? 2 : 0, second = 2 - first;
  j.inB.axis[first] = toBody(stateAt(j.b), toWorld(stateAt(j.a), j.inA.axis[first]));
  j.inA.axis[second] = toBody(stateAt(j.a), toWorld(stateAt(j.b), j.inB.axis[second]));
}

/// The numbers that depend on the relative rotation of the bodies.
void WorldModel::setRelativeRotation(Joint& j) {
  restart(j);
  switch (j.type) {
    case JointType::hinge:
      j.inA.rotation = relativeRotation(stateAt(j.a), stateAt(j.b));
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
  remember(j, JointCall::setFixed, 0, Vec3::Zero());
  const DynamicState *a = stateAt(j.a), *b = stateAt(j.b);
  j.inA.anchor = b ? pointToBody(a, b->position) : Vec3(Vec3::Zero());
  j.inB.anchor = b ? Vec3(Vec3::Zero()) : a->position;
  j.inA.rotation = relativeRotation(a, b);
}

void WorldModel::setAngularMotor(JointHandle joint, int axes, bool euler) {
  Joint& j = of(joint);
  if (j.type != JointType::angularMotor) return;
  if (axes < 0 || axes > 3) throw Error(fmt::format("expected 0 to 3 axes of an angular motor, found {}", axes));
  j.motor.euler = euler;
  j.motor.axes = euler ? 3 : axes;
  if (euler) setEulerReferences(j);
  remember(j, JointCall::setMotor, j.motor.axes, Vec3::Zero(), euler);
}

void WorldModel::setMotorAngle(JointHandle joint, int axis, double angle) {
  Joint& j = of(joint);
  if (j.type != JointType::angularMotor || j.motor.euler || axis < 0 || axis >= 3 || !std::isfinite(angle)) return;
  j.motor.angle[axis] = angle;
  remember(j, JointCall::setAngle, axis, Vec3(angle, 0, 0));
}

}  // namespace spark::physics
