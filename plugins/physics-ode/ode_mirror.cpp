#include <Eigen/Geometry>

#include "ode_world.h"

// ODE stores the anchors, axes and relative rotations of a joint in the frames of its bodies, from their poses at the
// time when the joint is set. It gives no access to these numbers, but a solver needs them. So every call that sets a
// joint in ODE is followed by a call here, which computes the same numbers from the same poses and stores them in the
// SolverJoint.
//
// The frame of a missing body is the world frame. When a joint is attached again, it keeps the numbers in the frame of
// its first body and computes the others from them, as ODE does. A fixed joint and an angular motor keep all numbers.

namespace spark::ode {

using engine::JointType;
using engine::SolverBody;

namespace {

// Directions and points between a body's frame and the world frame.

Vec3 toWorld(const SolverBody* b, const Vec3& direction) {
  return b ? Vec3(toMat(b->rotation) * direction) : direction;
}
Vec3 toBody(const SolverBody* b, const Vec3& direction) {
  return b ? Vec3(toMat(b->rotation).transpose() * direction) : direction;
}
Vec3 pointToWorld(const SolverBody* b, const Vec3& p) { return b ? Vec3(toWorld(b, p) + toVec(b->position)) : p; }
Vec3 pointToBody(const SolverBody* b, const Vec3& p) { return b ? toBody(b, p - toVec(b->position)) : p; }

using Quaternion = std::array<double, 4>;

/// The rotation `q`, given relative to the world, relative to a body.
Quaternion relativeTo(const SolverBody* b, const Quaternion& q) {
  if (!b) return q;
  Quaternion out;
  dQMultiply1(out.data(), b->quaternion, q.data());
  return out;
}

/// The rotation of the second body relative to the first.
Quaternion relativeRotation(const JointData& j) {
  Quaternion second{1, 0, 0, 0};
  if (j.b) std::copy(j.b->quaternion, j.b->quaternion + 4, second.begin());
  return relativeTo(j.a, second);
}

/// The rotation of a frame whose first axis is `x` and whose second axis is `y`, made perpendicular to it.
Quaternion frameOf(const Vec3& x, const Vec3& y) {
  dMatrix3 r;
  dRFrom2Axes(r, x.x(), x.y(), x.z(), y.x(), y.y(), y.z());
  Quaternion q;
  dRtoQ(r, q.data());
  return q;
}

/// Universal joint: the frames of the two axes, relative to each body.
void setUniversalFrames(JointData& j) {
  const Vec3 first = toWorld(j.a, j.axisA[0]), second = toWorld(j.b, j.axisB[1]);
  j.initialRotationA = relativeTo(j.a, frameOf(first, second));
  j.initialRotationB = relativeTo(j.b, frameOf(second, first));
}

/// Hinge2: the zero direction of each angle is the other axis, made perpendicular to its own.
void setHinge2Planes(JointData& j) {
  const Vec3 first = toWorld(j.a, j.axisA[0]), second = toWorld(j.b, j.axisB[1]);
  const Vec3 fromFirst = (second - first.dot(second) * first).normalized(),
             fromSecond = (first - first.dot(second) * second).normalized();
  j.planeA[0] = toBody(j.a, fromFirst);
  j.planeA[1] = toBody(j.a, first.cross(fromFirst));
  j.planeB[0] = toBody(j.b, fromSecond);
  j.planeB[1] = toBody(j.b, second.cross(fromSecond));
}

/// Hinge2: the angle between the axes, and the zero directions.
void setHinge2Axes(JointData& j) {
  const Vec3 first = toWorld(j.a, j.axisA[0]), second = toWorld(j.b, j.axisB[1]);
  j.sinAxes = first.cross(second).norm();
  j.cosAxes = first.dot(second);
  setHinge2Planes(j);
}

void setSliderOffset(JointData& j) {
  j.anchorB = pointToBody(j.b, toVec(j.a->position));
  j.initialRotationA = relativeRotation(j);
}

/// Euler motor: the zero direction of each angle is the other body's axis.
void setEulerReferences(JointData& j) {
  if (!j.a) return;
  const int first = j.reversed ? 2 : 0, second = 2 - first;
  j.reference2 = toBody(j.b, toWorld(j.a, j.axisA[first]));
  j.reference1 = toBody(j.a, toWorld(j.b, j.axisA[second]));
}

/// The numbers that depend on the relative rotation of the bodies.
void setRelativeRotation(JointData& j) {
  switch (j.type) {
    case JointType::hinge:
      j.initialRotationA = relativeRotation(j);
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

}  // namespace

void mirror::created(JointData& j) {
  // ODE's initial values.
  const engine::WorldParameters& p = j.world->parameters;
  for (engine::SolverAxis& a : j.axes) {
    a.cfm = a.stopCfm = p.cfm;
    a.stopErp = p.erp;
  }
  j.erp = j.suspensionErp = p.erp;
  j.cfm = j.suspensionCfm = p.cfm;
  j.axisA.fill(Vec3::Zero());
  j.axisB.fill(Vec3::Zero());
  if (j.type == JointType::fixed) j.initialRotationA.fill(0);
  if (j.type == JointType::angularMotor) return;
  j.axisA[0] = j.axisB[0] = j.planeA[0] = Vec3::UnitX();
  j.axisB[1] = j.planeA[1] = Vec3::UnitY();
}

void mirror::worldParametersSet(JointData& j) {
  // Ball and fixed joints keep the values that the world had when they were created.
  if (j.type == JointType::ball || j.type == JointType::fixed) return;
  j.erp = j.world->parameters.erp;
  j.cfm = j.world->parameters.cfm;
}

void mirror::attached(JointData& j) {
  ++j.world->angleVersion;
  if (!j.attached()) return;
  switch (j.type) {
    case JointType::fixed:
    case JointType::angularMotor:
      return;
    case JointType::slider:
      return setSliderOffset(j);
    case JointType::hinge:
      j.axisB[0] = toBody(j.b, toWorld(j.a, j.axisA[0]));
      break;
    case JointType::hinge2:
      setHinge2Axes(j);
      break;
    default:
      break;
  }
  anchorSet(j, j.reversed ? j.anchorB : pointToWorld(j.a, j.anchorA));
}

void mirror::anchorSet(JointData& j, const Vec3& world) {
  ++j.world->angleVersion;
  j.anchorA = pointToBody(j.a, world);
  j.anchorB = pointToBody(j.b, world);
  setRelativeRotation(j);
}

void mirror::axisSet(JointData& j, int axis, const Vec3& world, int frame) {
  ++j.world->angleVersion;
  const Vec3 direction = world.normalized();
  // ODE does not normalise an axis in the world frame.
  const Vec3 second = j.b ? toBody(j.b, direction) : world;
  switch (j.type) {
    case JointType::hinge:
      j.axisA[0] = toBody(j.a, direction);
      j.axisB[0] = second;
      break;
    case JointType::slider:
      j.axisA[0] = toBody(j.a, direction);
      return setSliderOffset(j);
    case JointType::universal:
      (axis == 0) == j.reversed ? j.axisB[1] = second : j.axisA[0] = toBody(j.a, direction);
      break;
    case JointType::hinge2:
      axis == 0 ? j.axisA[0] = toBody(j.a, direction) : j.axisB[1] = second;
      return setHinge2Axes(j);
    case JointType::angularMotor:
      if (frame != 0 && j.reversed) frame = 3 - frame;
      j.frame[axis] = frame;
      j.axisA[axis] = toBody(frame == 1 ? j.a : frame == 2 ? j.b : nullptr, world).normalized();
      if (j.euler) setEulerReferences(j);
      return;
    default:
      break;
  }
  setRelativeRotation(j);
}

void mirror::motorModeSet(JointData& j, int axes, bool euler) {
  j.euler = euler;
  j.motorAxes = euler ? 3 : axes;
  if (euler) setEulerReferences(j);
}

void mirror::fixedSet(JointData& j) {
  j.anchorA = j.b ? pointToBody(j.a, toVec(j.b->position)) : Vec3(Vec3::Zero());
  j.anchorB = j.b ? Vec3(Vec3::Zero()) : toVec(j.a->position);
  j.initialRotationA = relativeRotation(j);
}

}  // namespace spark::ode
