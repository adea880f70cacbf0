#include "added_forces.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "joint_frames.h"

namespace spark::physics {

using engine::axesOf;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointAxis;
using engine::JointType;
using engine::kNone;

void AddedForces::look() {
  const std::pair now{world_.model.structure, world_.model.dynamics};
  if (std::exchange(lookedAt_, now) == now) return;
  damped_ = sprung_ = bodiesDamped_ = false;
  for (const Joint& j : world_.model.joints)
    for (const JointAxis& a : j.axes) damped_ |= a.damping > 0, sprung_ |= a.stiffness > 0;
  for (const engine::Body& b : world_.model.bodies) bodiesDamped_ |= b.linearDamping > 0 || b.angularDamping > 0;
}

void AddedForces::add(const engine::Capabilities& can, double dt) {
  look();
  if (!can.controls) addControls();
  if (!can.damping && damped_) addDamping();
  if (!can.springs && sprung_) addSprings();
  if (!can.bodyDamping && bodiesDamped_) addBodyDamping(dt);
}

void AddedForces::addAlong(const Joint& j, int axis, double force) {
  const Vec3 along = angleSign(j, axis) * force * joints_.worldAxis(j, axis);
  DynamicState& a = world_.state.bodies[j.a];
  DynamicState* b = j.b == kNone ? nullptr : &world_.state.bodies[j.b];
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

bool AddedForces::acts(const Joint& j) const {
  return attached(j) && (world_.state.bodies[j.a].awake || (j.b != kNone && world_.state.bodies[j.b].awake));
}

void AddedForces::addControls() {
  for (const engine::AxisControl& c : world_.state.controls)
    if (const Joint& j = world_.model.joints[c.joint]; acts(j))
      addAlong(j, c.axis, c.control.at(joints_.angle(c.joint, c.axis), joints_.exactRate(c.joint, c.axis)));
}

void AddedForces::addDamping() {
  for (Index i = 0; i < world_.model.joints.size(); ++i) {
    const Joint& j = world_.model.joints[i];
    for (int axis = 0; axis < axesOf(j.type); ++axis)
      if (j.axes[axis].damping > 0 && acts(j)) addAlong(j, axis, -j.axes[axis].damping * joints_.exactRate(i, axis));
    if (j.type != JointType::ball || j.axes[0].damping == 0 || !acts(j)) continue;
    const Vec3 torque =
        j.axes[0].damping * (angularVelocity(world_.stateAt(j.b)) - angularVelocity(world_.stateAt(j.a)));
    world_.state.bodies[j.a].torque += torque;
    if (j.b != kNone) world_.state.bodies[j.b].torque -= torque;
  }
}

void AddedForces::addBodyDamping(double dt) {
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  for (Index i = 0; i < world_.model.bodies.size(); ++i) {
    const engine::Body& b = world_.model.bodies[i];
    DynamicState& s = world_.state.bodies[i];
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

void AddedForces::addSprings() {
  for (Index i = 0; i < world_.model.joints.size(); ++i)
    for (int axis = 0; axis < axesOf(world_.model.joints[i].type); ++axis)
      if (const Joint& j = world_.model.joints[i]; j.axes[axis].stiffness > 0 && acts(j))
        addAlong(j, axis, j.axes[axis].stiffness * (j.axes[axis].springPosition - joints_.angle(i, axis)));
}

}  // namespace spark::physics
