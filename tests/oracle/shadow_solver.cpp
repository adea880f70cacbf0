#include "shadow_solver.h"

#include "../../plugins/physics-ode/ode_engine.h"
#include "api/phases.h"

namespace spark::oracle {

using engine::SolverBody;

void ShadowSolver::describe(Description<ShadowSolver>& d) {
  d.doc("Compares a solver with ODE.");
  d.implements<engine::ISolver>();
  d.on<&ShadowSolver::placed>(phase::kPlace);
}

ShadowSolver& watch(Kernel& kernel, const std::string& path) {
  kernel.registerClass<ShadowSolver>();
  kernel.plugins().use("physics-articulated");
  auto& shadow = kernel.create<ShadowSolver>("ShadowSolver", path + "/solver");
  shadow.Node::create("ArticulatedSolver", "tested");
  return shadow;
}

namespace {
/// Copies the state of a body, to or from State.
template <class From, class To>
void copyState(const From& from, To& to) {
  std::copy_n(from.position, 3, to.position);
  std::copy_n(from.quaternion, 4, to.quaternion);
  std::copy_n(from.rotation, 12, to.rotation);
  std::copy_n(from.linearVelocity, 3, to.linearVelocity);
  std::copy_n(from.angularVelocity, 3, to.angularVelocity);
  std::copy_n(from.force, 3, to.force);
  std::copy_n(from.torque, 3, to.torque);
  to.awake = from.awake;
}
}  // namespace

ShadowSolver::State ShadowSolver::stateOf(const SolverBody& b) {
  State s;
  copyState(b, s);
  return s;
}

void ShadowSolver::restore(const State& s, SolverBody& b) {
  copyState(s, b);
  b.deferred = true;
}

std::size_t ShadowSolver::step(engine::SolverStep& step) {
  bodies_.assign(step.bodies.begin(), step.bodies.end());
  joints_.assign(step.joints.begin(), step.joints.end());
  contacts_ = step.contacts;
  pairs_ = step.pairs;
  before_.clear();
  for (const SolverBody* b : bodies_) before_.push_back(stateOf(*b));
  agreement_.deferred += childOf<engine::ISolver>()->step(step);
  answers_.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    SolverBody& b = *bodies_[i];
    answers_.push_back(
        {ode::toVec(b.linearVelocity), ode::toVec(b.angularVelocity), ode::toVec(b.position), b.awake, b.deferred});
    restore(before_[i], b);
  }
  jointForces_.clear();
  for (const engine::SolverJoint* j : joints_) jointForces_.push_back({j->forceA, j->torqueA, j->forceB, j->torqueB});
  contactForces_.clear();
  for (engine::Contact& c : contacts_) {
    contactForces_.push_back(c.forceOnA);
    c.forceOnA.setZero();
  }
  waiting_ = true;
  return bodies_.size();
}

void ShadowSolver::forget(engine::World world) {
  if (auto* tested = childOf<engine::ISolver>()) tested->forget(world);
}

void ShadowSolver::compare() {
  if (!waiting_) return;
  waiting_ = false;
  ++agreement_.steps;
  double speed = 0.01, spin = 0.01;
  for (const SolverBody* b : bodies_) {
    speed = std::max(speed, ode::toVec(b->linearVelocity).norm());
    spin = std::max(spin, ode::toVec(b->angularVelocity).norm());
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const SolverBody& b = *bodies_[i];
    const Answer& a = answers_[i];
    if (a.deferred) continue;
    if (a.awake != b.awake) ++agreement_.disagreedOnSleep;
    if (!b.awake) continue;
    ++agreement_.compared;
    // NaN is the worst error, and stays it.
    const auto worse = [&](double error, double& worst) {
      if (error <= worst || std::isnan(worst)) return;
      worst = error;
      agreement_.worstStep = agreement_.steps;
    };
    worse((a.velocity - ode::toVec(b.linearVelocity)).norm() / speed, agreement_.speed);
    worse((a.spin - ode::toVec(b.angularVelocity)).norm() / spin, agreement_.spin);
    worse((a.position - ode::toVec(b.position)).norm(), agreement_.place);
  }
  compareForces();
}

void ShadowSolver::compareForces() {
  std::vector<std::pair<Vec3, Vec3>> both;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto& j = *static_cast<const ode::JointData*>(joints_[i]);
    if (!j.wantsFeedback || !j.a || !j.a->awake || answers_[j.a->index].deferred) continue;
    const auto& [forceA, torqueA, forceB, torqueB] = jointForces_[i];
    both.insert(both.end(), {{forceA, ode::toVec(j.feedback.f1)}, {torqueA, ode::toVec(j.feedback.t1)}});
    if (j.b) both.insert(both.end(), {{forceB, ode::toVec(j.feedback.f2)}, {torqueB, ode::toVec(j.feedback.t2)}});
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    if (contacts_[i].feedback && pairs_[i].a && !answers_[pairs_[i].a->index].deferred)
      both.emplace_back(contactForces_[i], contacts_[i].forceOnA);
  double greatest = 1;
  for (const auto& [ours, odes] : both) greatest = std::max(greatest, odes.norm());
  for (const auto& [ours, odes] : both)
    if (const double error = (ours - odes).norm() / greatest;
        !(error <= agreement_.force) && !std::isnan(agreement_.force))
      agreement_.force = error;
  agreement_.feedbacks += both.size();
}

}  // namespace spark::oracle
