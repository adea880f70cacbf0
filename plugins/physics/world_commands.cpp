#include "world_model.h"

// What is set at the axes of joints: numbers, motors, controllers and springs.

namespace spark::physics {

using engine::axesOf;
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

void WorldModel::setParameter(JointHandle joint, JointParameter p, int axis, double wanted) {
  Joint& j = of(joint);
  if (!hasParameter(j, p, axis) || std::isnan(wanted)) return;
  // An infinite stop means that there is none.
  const bool noStop = std::isinf(wanted) && (p == JointParameter::lowStop || p == JointParameter::highStop);
  const double v = rounded(noStop ? wanted : bounded(wanted));
  if (p == JointParameter::maxForce && v < 0) return;
  if (p == JointParameter::fudgeFactor && (v < 0 || v > 1)) return;
  if (p >= JointParameter::armature && v < 0) return;
  const Index index = joints_[joint];
  engine::Blocks& scene = model_.extensions.sceneJoints[index];
  auto soft = isSoft(p) ? scene.get<engine::JointSoftness>() : engine::JointSoftness{};
  if (std::exchange(*parameterOf(j, soft, motors_[index], p, axis), v) != v) rouse(j);
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
  if (passed.maxForce > 0) return;
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

void WorldModel::parameters(JointHandle joint, int axis, std::span<double> out) const {
  const Joint& j = of(joint);
  const Index index = joints_[joint];
  const auto soft = model_.extensions.sceneJoints[index].get<engine::JointSoftness>();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto p = static_cast<JointParameter>(i);
    out[i] = hasParameter(j, p, axis) ? *parameterOf(j, soft, motors_[index], p, axis) : 0;
  }
}

void WorldModel::drive(JointHandle joint, int axis, double speed) {
  const Joint& j = of(joint);
  if (!hasParameter(j, JointParameter::velocity, axis) || std::isnan(speed)) return;
  const Index index = joints_[joint];
  const double now = rounded(bounded(speed)), before = std::exchange(motors_[index][axis].velocity, now);
  if (now != before) rouse(j);
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
  for (int i = 0; i < wanted.termCount; ++i) {
    const engine::ControlTerm& t = wanted.terms[static_cast<std::size_t>(i)];
    const double term[] = {t.force, t.stiffness, t.damping};
    if (!inRange(term, 3) || !(t.least <= t.most)) return;
  }
  if (Index& at = controlAt_[index][axis]; at == kNone) {
    at = static_cast<Index>(state_.controls.size());
    state_.controls.push_back({index, axis, wanted});
  } else {
    state_.controls[at].control = wanted;
  }
  motors_[index][axis] = {};
  passMotor(index, axis);
  if (j.a != kNone && !state_.bodies[j.a].awake && !watch_.loading()) setEnabled(bodies_.handleOf(j.a), true);
}

const engine::Control* WorldModel::controlOf(JointHandle joint, int axis) const {
  const Index at = controlAt_[joints_[joint]][axis];
  return at == kNone ? nullptr : &state_.controls[at].control;
}

void WorldModel::endControl(Index joint, int axis) {
  const Index at = controlAt_[joint][axis];
  if (at == kNone) return;
  rouse(model_.joints[joint]);
  state_.controls.erase(state_.controls.begin() + at);
  listControls();
}

/// Finds the place of each controller anew.
void WorldModel::listControls() {
  controlAt_.assign(model_.joints.size(), {kNone, kNone, kNone});
  for (Index i = 0; i < state_.controls.size(); ++i) controlAt_[state_.controls[i].joint][state_.controls[i].axis] = i;
}

void WorldModel::setSpring(JointHandle joint, int axis, double stiffness, double position) {
  Joint& j = of(joint);
  if (axis < 0 || axis >= axesOf(j.type) || !(stiffness >= 0) || !std::isfinite(position)) return;
  const double k = bounded(stiffness);
  if (j.axes[axis].stiffness != k || j.axes[axis].springPosition != position) rouse(j);
  j.axes[axis].stiffness = k;
  j.axes[axis].springPosition = position;
  ++model_.dynamics;
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
