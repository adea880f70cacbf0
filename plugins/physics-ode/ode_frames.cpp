#include <Eigen/Geometry>

#include "ode_engine.h"

// A joint remembers where its bodies stood when it was set: anchors, axes and relative rotations in the bodies' frames.
// ODE keeps these numbers to itself, so they are noted here a second time, at the calls that make ODE note them, from
// the same poses. Where a body is missing its frame is the world's. A joint that is attached keeps what stands in its
// first body's frame and takes the rest from there, as ODE does; a fixed joint and an angular motor keep all they have.

namespace spark::ode {

using engine::JointType;
using engine::SolverBody;

namespace {

Vec3 toWorld(const SolverBody* b, const Vec3& direction) {
  return b ? Vec3(toMat(b->rotation) * direction) : direction;
}
Vec3 toBody(const SolverBody* b, const Vec3& direction) {
  return b ? Vec3(toMat(b->rotation).transpose() * direction) : direction;
}
Vec3 pointToWorld(const SolverBody* b, const Vec3& p) { return b ? Vec3(toWorld(b, p) + toVec(b->position)) : p; }
Vec3 pointToBody(const SolverBody* b, const Vec3& p) { return b ? toBody(b, p - toVec(b->position)) : p; }

using Quaternion = std::array<double, 4>;

/// `q` seen from a body.
Quaternion fromBody(const SolverBody* b, const Quaternion& q) {
  if (!b) return q;
  Quaternion out;
  dQMultiply1(out.data(), b->quaternion, q.data());
  return out;
}

/// The second body's rotation seen from the first.
Quaternion betweenBodies(const JointData& j) {
  Quaternion second{1, 0, 0, 0};
  if (j.b) std::copy(j.b->quaternion, j.b->quaternion + 4, second.begin());
  return fromBody(j.a, second);
}

/// The rotation of a cross whose first two directions are these.
Quaternion cross(const Vec3& x, const Vec3& y) {
  dMatrix3 r;
  dRFrom2Axes(r, x.x(), x.y(), x.z(), y.x(), y.y(), y.z());
  Quaternion q;
  dRtoQ(r, q.data());
  return q;
}

void noteCross(JointData& j) {
  const Vec3 first = toWorld(j.a, j.axisA[0]), second = toWorld(j.b, j.axisB[1]);
  j.initialRotationA = fromBody(j.a, cross(first, second));
  j.initialRotationB = fromBody(j.b, cross(second, first));
}

/// A wheel's angles are counted from the other axis, made perpendicular to its own.
void noteWheel(JointData& j) {
  const Vec3 first = toWorld(j.a, j.axisA[0]), second = toWorld(j.b, j.axisB[1]);
  const Vec3 fromFirst = (second - first.dot(second) * first).normalized(),
             fromSecond = (first - first.dot(second) * second).normalized();
  j.planeA[0] = toBody(j.a, fromFirst);
  j.planeA[1] = toBody(j.a, first.cross(fromFirst));
  j.planeB[0] = toBody(j.b, fromSecond);
  j.planeB[1] = toBody(j.b, second.cross(fromSecond));
}

void noteWheelAxes(JointData& j) {
  const Vec3 first = toWorld(j.a, j.axisA[0]), second = toWorld(j.b, j.axisB[1]);
  j.sinAxes = first.cross(second).norm();
  j.cosAxes = first.dot(second);
  noteWheel(j);
}

void noteSlider(JointData& j) {
  j.anchorB = pointToBody(j.b, toVec(j.a->position));
  j.initialRotationA = betweenBodies(j);
}

/// Euler angles are counted from where the other body's axis was.
void noteEuler(JointData& j) {
  if (!j.a) return;
  const int first = j.reversed ? 2 : 0, second = 2 - first;
  j.reference2 = toBody(j.b, toWorld(j.a, j.axisA[first]));
  j.reference1 = toBody(j.a, toWorld(j.b, j.axisA[second]));
}

/// What depends on how the bodies are turned to each other.
void noteRotation(JointData& j) {
  switch (j.type) {
    case JointType::hinge:
      j.initialRotationA = betweenBodies(j);
      break;
    case JointType::universal:
      noteCross(j);
      break;
    case JointType::hinge2:
      noteWheel(j);
      break;
    default:
      break;
  }
}

}  // namespace

void frames::created(JointData& j) {
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

void frames::worldChanged(JointData& j) {
  // The others took theirs when they were made.
  if (j.type == JointType::ball || j.type == JointType::fixed) return;
  j.erp = j.world->parameters.erp;
  j.cfm = j.world->parameters.cfm;
}

void frames::attached(JointData& j) {
  ++j.world->rotations;
  if (!j.attached()) return;
  switch (j.type) {
    case JointType::fixed:
    case JointType::angularMotor:
      return;
    case JointType::slider:
      return noteSlider(j);
    case JointType::hinge:
      j.axisB[0] = toBody(j.b, toWorld(j.a, j.axisA[0]));
      break;
    case JointType::hinge2:
      noteWheelAxes(j);
      break;
    default:
      break;
  }
  anchored(j, j.reversed ? j.anchorB : pointToWorld(j.a, j.anchorA));
}

void frames::anchored(JointData& j, const Vec3& world) {
  ++j.world->rotations;
  j.anchorA = pointToBody(j.a, world);
  j.anchorB = pointToBody(j.b, world);
  noteRotation(j);
}

void frames::turned(JointData& j, int axis, const Vec3& world, int frame) {
  ++j.world->rotations;
  const Vec3 direction = world.normalized();
  // ODE does not bring an axis in the world to length 1.
  const Vec3 second = j.b ? toBody(j.b, direction) : world;
  switch (j.type) {
    case JointType::hinge:
      j.axisA[0] = toBody(j.a, direction);
      j.axisB[0] = second;
      break;
    case JointType::slider:
      j.axisA[0] = toBody(j.a, direction);
      return noteSlider(j);
    case JointType::universal:
      (axis == 0) == j.reversed ? j.axisB[1] = second : j.axisA[0] = toBody(j.a, direction);
      break;
    case JointType::hinge2:
      axis == 0 ? j.axisA[0] = toBody(j.a, direction) : j.axisB[1] = second;
      return noteWheelAxes(j);
    case JointType::angularMotor:
      if (frame != 0 && j.reversed) frame = 3 - frame;
      j.frame[axis] = frame;
      j.axisA[axis] = toBody(frame == 1 ? j.a : frame == 2 ? j.b : nullptr, world).normalized();
      if (j.euler) noteEuler(j);
      return;
    default:
      break;
  }
  noteRotation(j);
}

void frames::motorChosen(JointData& j, int axes, bool euler) {
  j.euler = euler;
  j.motorAxes = euler ? 3 : axes;
  if (euler) noteEuler(j);
}

void frames::fixed(JointData& j) {
  j.anchorA = j.b ? pointToBody(j.a, toVec(j.b->position)) : Vec3(Vec3::Zero());
  j.anchorB = j.b ? Vec3(Vec3::Zero()) : toVec(j.a->position);
  j.initialRotationA = betweenBodies(j);
}

}  // namespace spark::ode
