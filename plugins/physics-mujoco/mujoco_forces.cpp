#include <Eigen/Geometry>
#include <algorithm>

#include "mujoco_world.h"

// What acts on a world in MuJoCo: motors, and forces on bodies with drag and damping.
//
// Motors: MuJoCo solves dry friction of a joint as a constraint whose force is bounded, and which demands an
// acceleration that brings the velocity to 0. With the motor's speed as reference in place of 0, and its force as the
// bound, that is a motor as Spark has it: a constraint on the speed, with a bounded force.

namespace spark::mujoco {

using engine::Model;
using engine::State;

bool MujocoWorld::passMotors(const State& state) {
  bool other = false;
  for (int dof = 0; dof < m_->nv; ++dof) {
    if (motors_[dof].joint == kNone) continue;
    const double most = state.motors[motors_[dof].joint][motors_[dof].axis].maxForce;
    other |= (most > 0) != (m_->dof_frictionloss[dof] > 0);
    m_->dof_frictionloss[dof] = most;
  }
  return other;
}

/// The drag of the medium on a box of the inertia of one of MuJoCo's bodies (MuJoCo's documentation, "Fluid forces",
/// inertia model).
MujocoWorld::Wrench MujocoWorld::dragOf(int body) const {
  if (m_->body_mass[body] < mjMINVAL) return {};
  const OptionNumbers& medium = options_;
  const auto axes = rotationAt(d_->ximat + 9 * body);
  const Vec3 centre = toVec(d_->xipos + 3 * body);
  const Vec3 v = axes.transpose() * (velocityOf(body, centre) - Vec3(medium.wind.data()));
  const Vec3 w = axes.transpose() * toVec(d_->cvel + 6 * body);
  const Vec3& e = boxes_[static_cast<std::size_t>(body)];  // edges
  const double diameter = e.sum() / 3, viscosity = medium.viscosity, density = medium.density;
  Vec3 f = -3 * kPi * diameter * viscosity * v, t = -kPi * diameter * diameter * diameter * viscosity * w;
  for (int i = 0; i < 3; ++i) {
    const double a = e[(i + 1) % 3], b = e[(i + 2) % 3];
    f[i] -= 0.5 * density * a * b * std::abs(v[i]) * v[i];
    t[i] -= density * e[i] * (a * a * a * a + b * b * b * b) / 64 * std::abs(w[i]) * w[i];
  }
  const Vec3 force = axes * f;
  return {axes * t + armOf(body, centre).cross(force), force};
}

bool MujocoWorld::isFree(int body) const {
  return m_->body_jntnum[body] > 0 && m_->jnt_type[m_->body_jntadr[body]] == mjJNT_FREE;
}

/// That of a free body comes with its joint. Where it is strong for the step it is weakened to what a free body would
/// feel if it were implicit, which joints only make heavier.
void MujocoWorld::addBodyDamping(const Model& model, Index body, Vec3& force, Vec3& torque) const {
  const engine::Body& b = model.bodies[body];
  const int id = bodyId_[body];
  if ((b.linearDamping == 0 && b.angularDamping == 0) || isFree(id)) return;
  const Vec3 arm = toVec(d_->xpos + 3 * id) - centreOf(id);
  const double least = 1 / b.inverseInertia.trace();  // at most the least moment of inertia
  const double strength =
      m_->opt.timestep * std::max(b.linearDamping * (1 / b.mass + arm.squaredNorm() / least), b.angularDamping / least);
  const double share = 1 / std::max(1.0, strength);
  const Vec3 drag = -share * b.linearDamping * velocityOf(id, toVec(d_->xpos + 3 * id));
  force += drag;
  torque += arm.cross(drag) - share * b.angularDamping * toVec(d_->cvel + 6 * id);
}

/// Forces on bodies as forces along the degrees of freedom. MuJoCo 2.2.2 would do so with a Jacobian of the whole world
/// for each body, in most of the time of a step.
void MujocoWorld::applyForces(const Model& model, const State& state) {
  mju_zero(d_->qfrc_applied, m_->nv);
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  bool any = false;
  for (Index i = 0; i < state.bodies.size(); ++i) {
    const int body = bodyId_[i];
    if (body < 0) continue;
    Vec3 force = state.bodies[i].force, torque = state.bodies[i].torque;
    if (!model.bodies[i].gravity) force -= model.bodies[i].mass * model.parameters.gravity;
    addBodyDamping(model, i, force, torque);
    if (force.isZero(0) && torque.isZero(0)) continue;
    any = true;
    wrenches_[static_cast<std::size_t>(body)] = {torque + armOf(body, centreOf(body)).cross(force), force};
  }
  const auto addDrag = [&](int body) { wrenches_[static_cast<std::size_t>(body)] += dragOf(body); };
  for (Index i = 0; ownDrag_ && i < trees_.links.size(); ++i) {
    if (trees_.links[i].body == kNone || origins_[i].mujocoBody < 0) continue;
    any = true;
    addDrag(origins_[i].mujocoBody);
    for (const int part : origins_[i].parts) addDrag(part);
  }
  if (!any) return;
  // From the leaves to the roots: all wrenches of a tree are about its centre of mass.
  for (int body = m_->nbody - 1; body > 0; --body) {
    const Wrench& own = wrenches_[static_cast<std::size_t>(body)];
    const int first = m_->body_dofadr[body];
    for (int dof = first; dof < first + m_->body_dofnum[body]; ++dof)
      d_->qfrc_applied[dof] += toVec(d_->cdof + 6 * dof).dot(own.torque) + toVec(d_->cdof + 6 * dof + 3).dot(own.force);
    Wrench& parent = wrenches_[static_cast<std::size_t>(m_->body_parentid[body])];
    parent += own;
  }
}

void MujocoWorld::passSpeeds(const State& state) {
  for (int row = 0; row < d_->nefc; ++row) {
    if (d_->efc_type[row] != mjCNSTR_FRICTION_DOF) continue;
    const DofMotor& motor = motors_[d_->efc_id[row]];
    if (motor.joint == kNone) continue;
    const engine::Motor& wanted = state.motors[motor.joint][motor.axis];
    d_->efc_frictionloss[row] = wanted.maxForce;
    d_->efc_aref[row] += d_->efc_KBIP[4 * row + 1] * wanted.velocity;
  }
}

}  // namespace spark::mujoco
