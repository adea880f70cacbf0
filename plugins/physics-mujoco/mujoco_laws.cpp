#include <algorithm>
#include <cmath>

#include "mujoco_world.h"

// What acts along the coordinates of a world in MuJoCo: controllers, the springs of joints, and controls of actuators.
//
// MuJoCo makes the damping of joints implicit, and nothing else. An explicit damper d throws a coordinate of mobility w
// about when d w dt > 2, and a spring k when k w dt^2 > 4. So the laws of controllers are implicit here, and springs
// the more so the stiffer they are (see AddedForces of the plugin `physics`, which does the same for other engines):
//
//     f - R v'   with the velocity v' = v + a dt after the step, that is   f - R v - (R dt) a.
//
// The first part is a force, the second one an inertia R dt beside that of the coordinate. It is added to MuJoCo's
// matrix of inertias before the solver runs, so contacts and stops meet the law as it is, too.
//
// A law with a bound is at its bound b at present, while f - R v = p is more. It has a smaller resistance, with which
// the velocity after the step is the same:
//
//     b / (1/w + R' dt) = p / (1/w + R dt);   where R' would be below 0 the bound acts in the whole step.
//
// MJCF files move as in MuJoCo alone (explicitLaws), where that is stable or has a bound.

namespace spark::mujoco {

using engine::Control;
using engine::State;

namespace {

/// What remains of the resistance of a law of which only `bounded` of the force `wanted` acts.
double boundedResistance(double resistance, double wanted, double bounded, double dt, double mobility) {
  if (bounded == wanted) return resistance;
  const double share = bounded / wanted;
  if (!(share > 0 && share < 1)) return 0;
  return std::max(0.0, share * resistance - (1 - share) / (dt * mobility));
}

/// The resistance that makes a spring implicit, the more the stiffer it is; `damping` acts beside it.
double springResistance(double stiffness, double damping, double dt, double mobility) {
  const double stiff = stiffness * dt * dt * mobility / (1 + damping * dt * mobility);
  return stiff > 1 ? (1 - 1 / stiff) * stiffness * dt : 0;
}

/// How MuJoCo integrates by itself.
struct Integrator {
  int kind;
  double dt;
  /// True if it is stable with an explicit spring and damper, one degree of freedom alone. `damping` is implicit
  /// where MuJoCo makes it so.
  bool isStable(double stiffness, double damping, double mobility, bool implicitDamping) const {
    const double spring = stiffness * dt * dt * mobility, damper = damping * dt * mobility;
    // The limits of Runge and Kutta's method on the real and the imaginary axis.
    if (kind == mjINT_RK4) return spring <= 8 && damper <= 2.78;
    return spring <= 4 + (implicitDamping ? 2 : -2) * damper;
  }
};

/// A force along a coordinate, and its resistance against the velocity after the step.
struct Law {
  double force = 0, resistance = 0;
};

Law lawOf(const Control& c, double angle, double rate, double dt, double mobility, bool dampingToo) {
  double wanted = c.stiffness * (c.position - angle) + c.damping * (c.velocity - rate) + c.force;
  double damping = c.damping, stiffness = c.stiffness;
  for (int i = 0; i < c.termCount; ++i) {
    const engine::ControlTerm& t = c.terms[static_cast<std::size_t>(i)];
    const double force = t.force - t.stiffness * angle - t.damping * rate, bounded = t.at(angle, rate);
    wanted += bounded;
    damping += boundedResistance(std::max(0.0, t.damping), force, bounded, dt, mobility);
    if (bounded == force) stiffness += std::max(0.0, t.stiffness);
  }
  const double ofSpring = springResistance(stiffness, damping, dt, mobility);
  wanted -= ofSpring * rate;
  const double force = std::clamp(wanted, -c.maxForce, c.maxForce);
  const double resistance = (dampingToo ? damping : 0) + ofSpring;
  return {force, boundedResistance(resistance, wanted, force, dt, mobility)};
}

/// True if MuJoCo alone keeps the law, explicit, from running away.
bool isTame(const Control& c, double mobility, const Integrator& integrator) {
  if (std::isfinite(c.maxForce)) return true;
  double stiffness = c.stiffness, damping = c.damping;
  for (int i = 0; i < c.termCount; ++i) {
    const engine::ControlTerm& t = c.terms[static_cast<std::size_t>(i)];
    if (std::isfinite(t.least) && std::isfinite(t.most)) continue;
    stiffness += std::max(0.0, t.stiffness), damping += std::max(0.0, t.damping);
  }
  return integrator.isStable(stiffness, damping, mobility, integrator.kind == mjINT_IMPLICIT);
}

}  // namespace

void MujocoWorld::applyLaws(const State& state) {
  std::fill(resistances_.begin(), resistances_.end(), 0.0);
  resists_ = false;
  for (const int actuator : actuators_)
    if (actuator >= 0) mju_zero(m_->actuator_biasprm + mjNBIAS * actuator, 3);
  for (const engine::AxisControl& c : state.controls) applyControl(c);
  applySprings();
  if (resists_) addInertias();
}

void MujocoWorld::applyControl(const engine::AxisControl& c) {
  const auto [joint, sign] = coordinates_[c.joint][c.axis];
  if (joint < 0) return;
  const Control& own = c.control;
  const bool actuated = !actuators_.empty();
  if (actuated) passControl(own, joint, sign);
  const int dof = m_->jnt_dofadr[joint];
  const double angle = sign * d_->qpos[m_->jnt_qposadr[joint]], rate = sign * d_->qvel[dof];
  // The force of an actuator is MuJoCo's.
  const double present = own.at(angle, rate), by = actuated ? present : 0;
  if (own.stiffness == 0 && own.damping == 0 && own.termCount == 0) {
    d_->qfrc_applied[dof] += sign * (present - by);
    return;
  }
  const double dt = m_->opt.timestep, mobility = mobilityOf(dof);
  Law law{present, 0};
  const bool tame = options_.explicitLaws != 0 && isTame(own, mobility, {m_->opt.integrator, dt});
  if (!tame) {
    law = lawOf(own, angle, rate, dt, mobility, !actuated);
    if (options_.explicitLaws != 0 && stiffJoint_ == kNone) stiffJoint_ = c.joint;
  }
  d_->qfrc_applied[dof] += sign * (law.force - by);
  resistances_[static_cast<std::size_t>(dof)] += law.resistance;
  resists_ |= law.resistance > 0;
}

void MujocoWorld::passControl(const Control& own, int joint, double sign) {
  const int actuator = actuators_[static_cast<std::size_t>(joint)];
  mjtNum* bias = m_->actuator_biasprm + mjNBIAS * actuator;
  bias[0] = sign * (own.stiffness * own.position + own.damping * own.velocity + own.force);
  bias[1] = -own.stiffness;
  bias[2] = -own.damping;
  m_->actuator_forcelimited[actuator] = std::isfinite(own.maxForce);
  m_->actuator_forcerange[2 * actuator] = -own.maxForce;
  m_->actuator_forcerange[2 * actuator + 1] = own.maxForce;
  if (own.termCount == 0) return;
  // Each term has a range of its own: the actuator has their sum without ranges, whose damping is implicit, and what
  // the ranges take away acts beside it.
  Control whole = own;
  whole.maxForce = HUGE_VAL;
  m_->actuator_forcelimited[actuator] = 0;
  for (int k = 0; k < own.termCount; ++k) {
    engine::ControlTerm& term = whole.terms[static_cast<std::size_t>(k)];
    term.least = -HUGE_VAL, term.most = HUGE_VAL;
    bias[0] += sign * term.force;
    bias[1] -= term.stiffness;
    bias[2] -= term.damping;
  }
  const int dof = m_->jnt_dofadr[joint];
  const double angle = sign * d_->qpos[m_->jnt_qposadr[joint]], rate = sign * d_->qvel[dof];
  d_->qfrc_applied[dof] += sign * (own.at(angle, rate) - whole.at(angle, rate));
}

/// The forces of springs are MuJoCo's; so is implicit damping, but for Runge and Kutta's method.
void MujocoWorld::applySprings() {
  const double dt = m_->opt.timestep;
  const bool rungeKutta = m_->opt.integrator == mjINT_RK4;
  for (int joint = 0; joint < m_->njnt; ++joint) {
    const int type = m_->jnt_type[joint], dof = m_->jnt_dofadr[joint];
    if (type != mjJNT_HINGE && type != mjJNT_SLIDE) continue;
    const double stiffness = m_->jnt_stiffness[joint], damping = m_->dof_damping[dof];
    if (!(stiffness > 0) && !(rungeKutta && damping > 0)) continue;
    const double mobility = mobilityOf(dof);
    if (options_.explicitLaws != 0) {
      if (Integrator{m_->opt.integrator, dt}.isStable(stiffness, damping, mobility, true)) continue;
      if (stiffJoint_ == kNone) stiffJoint_ = motors_[dof].joint;
    }
    const double ofSpring = springResistance(stiffness, damping, dt, mobility);
    d_->qfrc_applied[dof] -= ofSpring * d_->qvel[dof];
    resistances_[static_cast<std::size_t>(dof)] += ofSpring + (rungeKutta ? damping : 0);
    resists_ |= ofSpring > 0 || rungeKutta;
  }
}

void MujocoWorld::addInertias() {
  const double dt = m_->opt.timestep;
  // Regularisation is relative to the inertia of a coordinate.
  for (int row = 0; row < d_->nefc; ++row) {
    const int type = d_->efc_type[row], id = d_->efc_id[row];
    if (type != mjCNSTR_FRICTION_DOF && type != mjCNSTR_LIMIT_JOINT) continue;
    const int dof = type == mjCNSTR_FRICTION_DOF ? id : m_->jnt_dofadr[id];
    const double heavier = 1 + dt * resistances_[static_cast<std::size_t>(dof)] * m_->dof_invweight0[dof];
    d_->efc_D[row] *= heavier;
    d_->efc_R[row] /= heavier;
  }
  for (int dof = 0; dof < m_->nv; ++dof) d_->qM[m_->dof_Madr[dof]] += dt * resistances_[static_cast<std::size_t>(dof)];
  mj_factorM(m_.get(), d_.get());
  mj_projectConstraint(m_.get(), d_.get());
}

/// An element of the diagonal of the inverse of M = L' D L (Featherstone, Rigid Body Dynamics Algorithms, 2008, section
/// 6.5): that of a row of L'^-1 over D, which has only what is above the coordinate in its tree.
double MujocoWorld::mobilityOf(int dof) {
  const auto at = [this](int i) -> double& { return mobilities_[static_cast<std::size_t>(i)]; };
  for (int i = dof; i >= 0; i = m_->dof_parentid[i]) at(i) = 0;
  at(dof) = 1;
  double sum = 0;
  for (int i = dof; i >= 0; i = m_->dof_parentid[i]) {
    sum += at(i) * at(i) * d_->qLDiagInv[i];
    const mjtNum* element = d_->qLD + m_->dof_Madr[i] + 1;
    for (int above = m_->dof_parentid[i]; above >= 0; above = m_->dof_parentid[above]) at(above) -= *element++ * at(i);
  }
  return sum;
}

void MujocoWorld::passInputs(const State& state) {
  for (const auto& [kind, actuator] : inputs_)
    for (const engine::BlockInput& input : state.inputs)
      if (input.kind == kind) d_->ctrl[actuator] = input.value;
}

}  // namespace spark::mujoco
