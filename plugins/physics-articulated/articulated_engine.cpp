#include "articulated_engine.h"

#include <algorithm>
#include <limits>

#include "spark/plugin.h"

namespace spark {

engine::IEngine* ArticulatedEngine::deferred() {
  if (!deferred_) return nullptr;
  if (deferred_->capabilities().parts) return deferred_.get();
  if (!std::exchange(unfit_, true))
    kernel().log().warning("{}: {} cannot step single islands; it has no effect here", path(),
                           deferred_->leaf().path());
  return nullptr;
}

namespace articulated {

void ArticulatedSolver::step(engine::Step& step) {
  Jobs& jobs = engine_.kernel().jobs();
  engine::IEngine* const deferred = engine_.deferred();
  const int mostRows = deferred ? engine_.mostRows_ : std::numeric_limits<int>::max();
  const Stepper::Counts before = stepper_.counts();
  const std::span<const std::uint8_t> others =
      stepper_.step(step, mostRows, static_cast<std::size_t>(jobs.threads()),
                    [&](std::size_t n, const auto& work) { jobs.run(n, work); });
  engine_.counts_ += stepper_.counts() - before;
  if (others.empty()) return;
  if (!deferred) return hold(step, others);
  if (deferred_.startsAnew(*deferred)) deferredKnows_ = false;
  engine::ISolver& solver = deferred_.of(*deferred, step.model);
  if (!std::exchange(deferredKnows_, true)) solver.compile(step.model, step.state);
  engine::Step rest{step.model, step.state, step.contacts, step.dt, others};
  solver.step(rest);
}

void ArticulatedSolver::hold(engine::Step& step, std::span<const std::uint8_t> bodies) {
  for (engine::Index i = 0; i < bodies.size(); ++i) {
    if (!bodies[i]) continue;
    engine::DynamicState& s = step.state.bodies[i];
    for (Vec3* v : {&s.linearVelocity, &s.angularVelocity, &s.force, &s.torque}) v->setZero();
    s.awake = true;
    ++s.version;
    step.state.markMoved(i);
  }
  if (!std::exchange(engine_.held_, true))
    engine_.kernel().log().warning(
        "{}: no solution was found for an island; its bodies are held for the step. An engine below would step it: "
        "new(\"OdeEngine\", \"{}/deferred\")",
        engine_.path(), engine_.path());
}

}  // namespace articulated
}  // namespace spark

SPARK_PLUGIN("physics-articulated", "1.0", "An engine for articulated bodies.", spark::ArticulatedEngine)
