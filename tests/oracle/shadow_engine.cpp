#include "shadow_engine.h"

#include <cmath>

namespace spark::oracle {

using engine::DynamicState;
using engine::IEngine;
using engine::Index;
using engine::kNone;

void DeferralRecorder::describe(Description<DeferralRecorder>& d) {
  d.doc("Records which bodies were deferred.");
  d.implements<IEngine>();
}

struct DeferralRecorder::Solver : engine::ISolver {
  explicit Solver(DeferralRecorder& recorder) : node(recorder) {}
  void step(engine::Step& step) override {
    node.deferred_.resize(step.model.bodies.size());
    for (Index i = 0; i < node.deferred_.size(); ++i) node.deferred_[i] = step.steps(i);
  }
  DeferralRecorder& node;
};

std::unique_ptr<engine::ISolver> DeferralRecorder::create(const engine::Model&) {
  return std::make_unique<Solver>(*this);
}

void ShadowEngine::describe(Description<ShadowEngine>& d) {
  d.doc("Compares an engine with ODE.");
  d.implements<IEngine>();
  d.link(&ShadowEngine::tested_, At<IEngine>("tested"));
  d.link(&ShadowEngine::judge_, At<IEngine>("judge"));
  d.link(&ShadowEngine::recorder_, At<DeferralRecorder>("tested/deferred"));
}

ShadowEngine& watch(Kernel& kernel, const std::string& path) {
  kernel.registerClass<DeferralRecorder>();
  kernel.registerClass<ShadowEngine>();
  kernel.plugins().use("physics-articulated");
  if (Leaf* replaced = kernel.root().find(path)) replaced->parent()->remove(*replaced);
  auto& shadow = kernel.create<ShadowEngine>("ShadowEngine", path);
  shadow.Node::create<Node>("ArticulatedEngine", "tested").create("DeferralRecorder", "deferred");
  shadow.Node::create("OdeEngine", "judge");
  return shadow;
}

ShadowEngine::Result ShadowEngine::Result::of(const engine::Step& step) {
  Result r{step.state, {}};
  for (const engine::Contact& c : step.contacts) r.contactForces.push_back(c.forceOnA);
  return r;
}

void ShadowEngine::Result::restore(engine::Step& step) const {
  step.state = state;
  for (std::size_t i = 0; i < contactForces.size(); ++i) step.contacts[i].forceOnA = contactForces[i];
}

struct ShadowEngine::Solver : engine::ISolver {
  explicit Solver(ShadowEngine& shadow) : node(shadow) {}
  void compile(const engine::Model& model, const engine::State& state) override {
    tested.of(*node.tested_, model).compile(model, state);
    judge.of(*node.judge_, model).compile(model, state);
  }
  void step(engine::Step& step) override {
    const Result before = Result::of(step);
    node.recorder_->clear();
    tested.of(*node.tested_, step.model).step(step);
    const Result results = Result::of(step);
    before.restore(step);
    judge.of(*node.judge_, step.model).step(step);
    node.compare(results, step);
  }
  ShadowEngine& node;
  engine::Attached<IEngine> tested, judge;
};

std::unique_ptr<engine::ISolver> ShadowEngine::create(const engine::Model&) { return std::make_unique<Solver>(*this); }

void ShadowEngine::record(double error, double& worst) {
  if (error <= worst || std::isnan(worst)) return;
  worst = error;
  agreement_.worstStep = agreement_.steps;
}

void ShadowEngine::compare(const Result& tested, const engine::Step& judged) {
  ++agreement_.steps;
  const std::vector<DynamicState>& bodies = judged.state.bodies;
  double speed = 0.01, spin = 0.01;
  for (const DynamicState& b : bodies) {
    speed = std::max(speed, b.linearVelocity.norm());
    spin = std::max(spin, b.angularVelocity.norm());
  }
  for (Index i = 0; i < bodies.size(); ++i) {
    const DynamicState &a = tested.state.bodies[i], &b = bodies[i];
    if (recorder_->deferred(i)) {
      ++agreement_.deferred;
      continue;
    }
    if (a.awake != b.awake) ++agreement_.disagreedOnSleep;
    if (a.moved != b.moved) ++agreement_.disagreedOnMoved;
    if (!b.awake) continue;
    ++agreement_.compared;
    record((a.linearVelocity - b.linearVelocity).norm() / speed, agreement_.speed);
    record((a.angularVelocity - b.angularVelocity).norm() / spin, agreement_.spin);
    record((a.position - b.position).norm(), agreement_.position);
  }
  compareForces(tested, judged);
}

void ShadowEngine::compareForces(const Result& tested, const engine::Step& judged) {
  std::vector<std::pair<Vec3, Vec3>> both;
  const auto comparable = [&](Index body) {
    return body != kNone && judged.state.bodies[body].awake && !recorder_->deferred(body);
  };
  for (std::size_t i = 0; i < judged.model.joints.size(); ++i) {
    const engine::Joint& j = judged.model.joints[i];
    if (!j.wantsFeedback || !comparable(j.a)) continue;
    const engine::JointState &a = tested.state.joints[i], &b = judged.state.joints[i];
    both.insert(both.end(), {{a.forceA, b.forceA}, {a.torqueA, b.torqueA}});
    if (j.b != kNone) both.insert(both.end(), {{a.forceB, b.forceB}, {a.torqueB, b.torqueB}});
  }
  for (std::size_t i = 0; i < judged.contacts.size(); ++i) {
    const engine::Contact& c = judged.contacts[i];
    const Index body = c.bodyA != kNone ? c.bodyA : c.bodyB;
    if (c.feedback && c.solve && body != kNone && !recorder_->deferred(body))
      both.emplace_back(tested.contactForces[i], c.forceOnA);
  }
  double largest = 1;
  for (const auto& [ours, odes] : both) largest = std::max(largest, odes.norm());
  for (const auto& [ours, odes] : both) record((ours - odes).norm() / largest, agreement_.force);
  agreement_.feedbacks += both.size();
}

}  // namespace spark::oracle
