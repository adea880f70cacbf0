#include "joint_rows.h"

#include "api/joint_stops.h"

// The rows of each joint type, as ODE has them (Smith, ODE manual, "Joint Types and Functions"): velocities are those
// of body a relative to b; a fraction erp of an error is removed in one step.

namespace spark::bullet {

using engine::DynamicState;
using engine::Joint;
using engine::JointAxis;
using engine::JointType;

namespace {

/// Distance from a stop beyond which no step reaches it, unless the axis moves [rad or m].
constexpr double kReach = 0.1;

/// A joint that is in no tree.
struct JointWriter {
  const engine::Step& step;
  RowSolver& out;
  const Joint& joint;
  const engine::JointSoftness& soft;
  const DynamicState& a;
  const DynamicState& b;
  Row base;  ///< with both sides

  Vec3 fromA(const Vec3& v) const { return a.rotation * v; }
  Vec3 fromB(const Vec3& v) const { return b.rotation * v; }
  double gain(double erp) const { return erp / step.dt; }
  double gain() const { return gain(step.model.parameters.erp); }
  double softness(double cfm) const { return cfm / step.dt; }
  double softness() const { return softness(step.model.parameters.cfm); }

  Row angular(const Vec3& axis, double target, double cfmOfRow) const {
    Row r = base;
    r.angular = axis, r.target = target, r.softness = cfmOfRow;
    return r;
  }
  Row point(const Vec3& direction, const Vec3& atA, const Vec3& atB, double target, double cfmOfRow) const {
    Row r = base;
    r.linear = direction, r.pointA = atA, r.pointB = atB, r.target = target, r.softness = cfmOfRow;
    return r;
  }
  void ball(double erp, double cfm) const {
    const Vec3 atA = a.position + fromA(joint.inA.anchor), atB = b.position + fromB(joint.inB.anchor);
    for (int i = 0; i < 3; ++i) out.addRow(point(Vec3::Unit(i), atA, atB, gain(erp) * (atB - atA)[i], softness(cfm)));
  }
  void sameRotation() const {
    const auto& q = joint.inA.rotation;
    const Eigen::Quaterniond initial(q[0], q[1], q[2], q[3]);
    if (initial.norm() == 0) {
      for (int i = 0; i < 3; ++i) out.addRow(angular(Vec3::Unit(i), 0, softness()));
      return;
    }
    // A small rotation q = (w, v) has the rotation vector 2 v.
    const Eigen::Quaterniond since(a.rotation.transpose() * b.rotation * initial.toRotationMatrix().transpose());
    const Vec3 error = 2 * fromA(since.w() < 0 ? Vec3(-since.vec()) : Vec3(since.vec()));
    for (int i = 0; i < 3; ++i) out.addRow(angular(Vec3::Unit(i), gain() * error[i], softness()));
  }
  void hinge() const {
    ball(step.model.parameters.erp, step.model.parameters.cfm);
    const Vec3 axis = fromA(joint.inA.axis[0]), error = axis.cross(fromB(joint.inB.axis[0]));
    Vec3 p, q;
    perpendicularBasis(axis, p, q);
    for (const Vec3& d : {p, q}) out.addRow(angular(d, gain() * error.dot(d), softness()));
  }
  void slider() const {
    sameRotation();
    const Vec3 offset = b.position + fromB(joint.inB.anchor) - a.position;
    Vec3 p, q;
    perpendicularBasis(fromA(joint.inA.axis[0]), p, q);
    for (const Vec3& d : {p, q}) out.addRow(point(d, a.position, a.position, gain() * d.dot(offset), softness()));
  }
  void universal() const {
    ball(step.model.parameters.erp, step.model.parameters.cfm);
    const Vec3 axis1 = fromA(joint.inA.axis[0]), axis2 = fromB(joint.inB.axis[1]);
    const double cosine = axis1.dot(axis2);
    out.addRow(angular(axis1.cross(axis2 - cosine * axis1).normalized(), -gain() * cosine, softness()));
  }
  void hinge2() const {
    const Vec3 axis1 = fromA(joint.inA.axis[0]), axis2 = fromB(joint.inB.axis[1]);
    const Vec3 atA = a.position + fromA(joint.inA.anchor), atB = b.position + fromB(joint.inB.anchor),
               error = atB - atA;
    Vec3 p, q;
    perpendicularBasis(axis1, p, q);
    out.addRow(point(axis1, atA, atB, gain(soft.suspensionErp) * axis1.dot(error), softness(soft.suspensionCfm)));
    for (const Vec3& d : {p, q}) out.addRow(point(d, atA, atB, gain() * d.dot(error), softness()));
    const Vec3 normal = axis1.cross(axis2);
    const double sine = normal.norm(), cosine = axis1.dot(axis2);
    out.addRow(angular(normal.normalized(), gain() * (joint.cosAxes * sine - joint.sinAxes * cosine), softness()));
  }
};

const DynamicState& stateOf(const engine::State& state, Index body) {
  static const DynamicState world;
  return body == kNone ? world : state.bodies[body];
}

/// Euler motor: for each angle the direction in which velocity changes it alone.
std::array<Vec3, 3> eulerDirections(const Joint& j, const DynamicState& a, const DynamicState& b) {
  // Axis 0 is fixed in the first body, axis 2 in the second. In a reversed joint, a is the second body.
  const std::size_t ofA = j.reversed ? 2 : 0, ofB = 2 - ofA;
  std::array<Vec3, 3> axis;
  axis[ofA] = a.rotation * j.inA.axis[ofA];
  axis[ofB] = b.rotation * j.inB.axis[ofB];
  axis[1] = axis[2].cross(axis[0]).normalized();
  return {axis[1].cross(axis[2]), axis[1], axis[0].cross(axis[1])};
}

}  // namespace

void JointRows::writeLaws(Index joint, int axis, const Row& base) const {
  laws.forEach(joint, axis, [&](const engine::AxisLaw& law) {
    const Joint& j = step.model.joints[joint];
    // The direction of the row is that in which coordinates count.
    const bool inB = axis == 1;
    const Vec3 own = stateOf(step.state, inB ? j.b : j.a).rotation * (inB ? j.inB.axis[1] : j.inA.axis[0]);
    const double cosine = own.dot(law.along),
                 sign = (j.type == JointType::slider && j.reversed ? -cosine : cosine) < 0 ? -1 : 1;
    // A force of F - R v: v = F / R - impulse / (R dt).
    Row row = base;
    row.target = sign * law.force / law.resistance;
    row.softness = 1 / (law.resistance * step.dt);
    row.low = -law.maxForce * step.dt, row.high = law.maxForce * step.dt;
    out.addRow(row);
  });
}

void JointRows::writeAxis(Index joint, int index, Row row, double position, double rate) const {
  const JointAxis& axis = step.model.joints[joint].axes[static_cast<std::size_t>(index)];
  const engine::JointSoftness::Axis& soft = softness[joint].axes[static_cast<std::size_t>(index)];
  const engine::Motor& motor = step.state.motors[joint][static_cast<std::size_t>(index)];
  const double dt = step.dt;
  // Axis 2 of a wheel has no stops.
  const bool wheel = step.model.joints[joint].type == JointType::hinge2 && index == 1;
  const bool stops = axis.lowStop <= axis.highStop && !wheel, locked = stops && axis.lowStop == axis.highStop;
  row.target = 0;
  writeLaws(joint, index, row);
  // Inertial forces of armature and damping, implicit: -armature (v - rate) / dt - damping v.
  if (const double inertia = axis.armature + axis.damping * dt; inertia > 0) {
    Row inertial = row;
    inertial.softness = 1 / inertia;
    inertial.target = axis.armature * rate / inertia;
    out.addRow(inertial);
  }
  if (motor.maxForce > 0 && !locked) {
    Row drive = row;
    drive.target = motor.velocity;
    drive.softness = soft.cfm / dt;
    drive.low = -motor.maxForce * dt, drive.high = motor.maxForce * dt;
    out.addRow(drive);
  }
  if (!stops) return;
  row.softness = soft.stopCfm / dt;
  if (locked) {
    row.target = engine::stopReturn(step.model.joints[joint].type, axis.lowStop - position, soft.stopErp, dt);
    out.addRow(row);
    return;
  }
  // A stop begins to act in the step that would pass it.
  const auto stop = [&](double at, double sign) {
    const double excess = sign * (at - position);  // above 0: beyond the stop
    if (excess < -kReach - 2 * std::abs(rate) * dt) return;
    Row r = row;
    r.target =
        sign * (excess > 0 ? engine::stopReturn(step.model.joints[joint].type, excess, soft.stopErp, dt) : excess / dt);
    const double approach = -sign * rate;
    if (soft.bounce > 0 && approach > 0 && excess + approach * dt > 0)
      r.target = sign * std::max(sign * r.target, soft.bounce * approach);
    (sign > 0 ? r.low : r.high) = 0;
    out.addRow(r);
  };
  if (std::isfinite(axis.lowStop)) stop(axis.lowStop, 1);
  if (std::isfinite(axis.highStop)) stop(axis.highStop, -1);
}

void JointRows::writeDof(TreeBody& tree, const Dof& dof) const {
  const engine::JointSoftness& soft = softness[dof.joint];
  Row row;
  row.a = {&tree.multiBody(), dof.link};
  row.offset = tree.offsetOf(dof);
  if (dof.axis < 0) {
    // The suspension of a wheel is a row of ERP and CFM.
    row.target = -soft.suspensionErp / step.dt * dof.position;
    row.softness = soft.suspensionCfm / step.dt;
    out.addRow(row);
    return;
  }
  writeAxis(dof.joint, dof.axis, row, dof.position, dof.rate);
}

void JointRows::writeBallDamping(Index joint, const Side& a, const Side& b) const {
  const double damping = step.model.joints[joint].axes[0].damping;
  if (damping == 0) return;
  for (int i = 0; i < 3; ++i) {
    Row row{.a = a, .b = b};
    row.angular = Vec3::Unit(i);
    row.softness = 1 / (damping * step.dt);
    out.addRow(row);
  }
}

void JointRows::writeJoint(Index index, const Side& sideA, const Side& sideB) const {
  const Joint& j = step.model.joints[index];
  const DynamicState &a = stateOf(step.state, j.a), &b = stateOf(step.state, j.b);
  const engine::JointSoftness& soft = softness[index];
  const JointWriter w{step, out, j, soft, a, b, {.a = sideA, .b = sideB}};
  const auto turning = [&](int axis, const Vec3& direction, double position) {
    writeAxis(index, axis, w.angular(direction, 0, 0), position, direction.dot(a.angularVelocity - b.angularVelocity));
  };
  const auto coordinate = [&](std::size_t axis) { return step.state.coordinates[index].at(axis); };
  switch (j.type) {
    case JointType::ball:
      w.ball(soft.erp, soft.cfm);
      writeBallDamping(index, sideA, sideB);
      break;
    case JointType::hinge:
      w.hinge();
      turning(0, w.fromA(j.inA.axis[0]), coordinate(0));
      break;
    case JointType::slider: {
      w.slider();
      const Vec3 axis = (j.reversed ? -1 : 1) * w.fromA(j.inA.axis[0]);
      const Vec3 offset = b.position + w.fromB(j.inB.anchor) - a.position;
      const Vec3 relative = a.linearVelocity - b.linearVelocity - b.angularVelocity.cross(a.position - b.position);
      writeAxis(index, 0, w.point(axis, a.position, a.position, 0, 0), -axis.dot(offset), axis.dot(relative));
      break;
    }
    case JointType::universal:
      w.universal();
      turning(0, w.fromA(j.inA.axis[0]), coordinate(0));
      turning(1, w.fromB(j.inB.axis[1]), coordinate(1));
      break;
    case JointType::hinge2:
      w.hinge2();
      turning(0, w.fromA(j.inA.axis[0]), coordinate(0));
      turning(1, w.fromB(j.inB.axis[1]), 0);
      break;
    case JointType::fixed:
      w.ball(soft.erp, soft.cfm);
      w.sameRotation();
      break;
    case JointType::angularMotor: {
      const auto euler = j.motor.euler ? eulerDirections(j, a, b) : std::array<Vec3, 3>{};
      for (int i = 0; i < (j.motor.euler ? 3 : j.motor.axes); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec3 &inA = j.inA.axis[k], &inB = j.inB.axis[k];
        const Vec3 user = j.motor.frame[k] == 1 ? w.fromA(inA) : j.motor.frame[k] == 2 ? w.fromB(inB) : inA;
        turning(i, j.motor.euler ? euler[k] : user, j.motor.euler ? coordinate(k) : j.motor.angle[k]);
      }
      break;
    }
  }
}

}  // namespace spark::bullet
