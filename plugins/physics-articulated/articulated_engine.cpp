#include "articulated_engine.h"

#include <algorithm>
#include <limits>

#include "spark/plugin.h"

namespace spark {

void ArticulatedEngine::compile(const engine::Model& model, const engine::State&) { std::erase(known_, model.id); }

void ArticulatedEngine::forget(const engine::Model& model) {
  stepper_.forget(model);
  if (deferred_) deferred_->forget(model);
  std::erase(known_, model.id);
}

void ArticulatedEngine::step(engine::Step& step) {
  Jobs& jobs = kernel().jobs();
  engine::IEngine* const deferred = deferred_ && deferred_->stepsParts() ? deferred_.get() : nullptr;
  if (deferred_ && !deferred && !std::exchange(unfit_, true))
    kernel().log().warning("{}: {} cannot step single islands; it has no effect here", path(),
                           deferred_->leaf().path());
  const int mostRows = deferred ? stepper_.maxCouplingRows : std::numeric_limits<int>::max();
  const std::span<const std::uint8_t> others =
      stepper_.step(step, mostRows, static_cast<std::size_t>(jobs.threads()),
                    [&](std::size_t n, const auto& work) { jobs.run(n, work); });
  if (others.empty()) return;
  if (!deferred) return hold(step, others);
  if (knownBy_.get() != &deferred->leaf()) known_.clear();
  knownBy_ = Ref<Leaf>(&deferred->leaf());
  if (std::find(known_.begin(), known_.end(), step.model.id) == known_.end()) {
    deferred->compile(step.model, step.state);
    known_.push_back(step.model.id);
  }
  engine::Step rest{step.model, step.state, step.contacts, step.dt, others};
  deferred->step(rest);
}

void ArticulatedEngine::hold(engine::Step& step, std::span<const std::uint8_t> bodies) {
  for (engine::Index i = 0; i < bodies.size(); ++i) {
    if (!bodies[i]) continue;
    engine::DynamicState& s = step.state.bodies[i];
    for (Vec3* v : {&s.linearVelocity, &s.angularVelocity, &s.force, &s.torque}) v->setZero();
    s.awake = true;
    step.state.markMoved(i);
  }
  if (!std::exchange(held_, true))
    kernel().log().warning(
        "{}: no solution was found for an island; its bodies are held for the step. An engine below would step it: "
        "new(\"OdeEngine\", \"{}/deferred\")",
        path(), path());
}

}  // namespace spark

SPARK_PLUGIN("physics-articulated", "1.0", "An engine for articulated bodies.", spark::ArticulatedEngine)
