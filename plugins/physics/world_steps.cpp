#include <algorithm>

#include "world_model.h"

// Steps of a world: what solver and detector have compiled, sleep, and bodies whose numbers went wrong.

namespace spark::physics {

using engine::DynamicState;
using engine::Index;
using engine::kNone;

template <class Maker>
template <class F>
typename Maker::Part& WorldModel::Compiled<Maker>::bring(Maker& maker, const engine::Model& model,
                                                         std::uint64_t version, F&& compile) {
  const bool fresh = attached.startsAnew(maker);
  auto& made = attached.of(maker, model);
  if (fresh) structure = part = UINT64_MAX;  // should the first compile() throw
  if (structure == model.structure && part == version) return made;
  compile(made);
  structure = model.structure;
  part = version;
  return made;
}

engine::ISolver& WorldModel::solver(engine::IEngine& engine) {
  // One that detects contacts has geoms, too.
  const engine::Capabilities can = engine.capabilities();
  const std::uint64_t version = model_.dynamics + (can.findsContacts() ? model_.collision : 0);
  if (engine_.attached.startsAnew(engine)) ownAt_ = {};
  return engine_.bring(engine, model_, version, [&](engine::ISolver& s) { s.compile(model_, state_); });
}

void WorldModel::bringOwn(engine::IDetector& detector) {
  const std::pair now{model_.structure, model_.collision};
  if (std::exchange(ownAt_, now) != now || !edited_.empty()) detector.compile(model_, state_, edited_);
}

void WorldModel::detect(engine::IEngine& engine, engine::ICollision* collision, engine::PairFilter filter, int perPair,
                        engine::Contacts& out) {
  compact();
  const auto compile = [&](engine::IDetector& d) { d.compile(model_, state_, edited_); };
  engine::IDetector* const own = engine.capabilities().detects ? solver(engine).detector() : nullptr;
  if (own || (collision && !engine.capabilities().late)) {
    engine::IDetector& detector = own ? *own : collision_.bring(*collision, model_, model_.collision, compile);
    if (own) bringOwn(*own);
    detector.detect(model_, state_, filter, perPair, out);
  }
  for (const Index g : edited_) geomEdited_[g] = 0;
  edited_.clear();
  for (const Index i : state_.moved) state_.bodies[i].moved = false;
  state_.moved.clear();
}

void WorldModel::putToSleep(const engine::Contacts& contacts, double dt) {
  for (const engine::Contact& c : contacts) {
    if (!c.solve) continue;
    if (c.bodyA != kNone) watch_[c.bodyA].lastContactStep = steps_;
    if (c.bodyB != kNone) watch_[c.bodyB].lastContactStep = steps_;
  }
  constexpr double kIdleSpeedSquared = 0.01 * 0.01;  // (m/s)^2 and (rad/s)^2
  for (Index i = 0; i < state_.bodies.size(); ++i) {
    DynamicState& s = state_.bodies[i];
    Watch& w = watch_[i];
    // A body without joints and contacts is in free flight: it does not fall asleep.
    if (!s.awake || (model_.bodies[i].joints == 0 && w.lastContactStep != steps_)) continue;
    if (dot(s.linearVelocity, s.linearVelocity) > kIdleSpeedSquared ||
        dot(s.angularVelocity, s.angularVelocity) > kIdleSpeedSquared) {
      w.idleStepsLeft = Watch{}.idleStepsLeft;
      w.idleTimeLeft = 0;
      continue;
    }
    // Idle: asleep when both counters have run out.
    --w.idleStepsLeft;
    w.idleTimeLeft -= dt;
    if (w.idleStepsLeft > 0 || w.idleTimeLeft > 0) continue;
    s.awake = false;
    s.linearVelocity.setZero();
    s.angularVelocity.setZero();
    ++s.version;
  }
}

void WorldModel::keepForces(bool on) {
  kept_.clear();
  if (!on) return;
  for (Index i = 0; i < state_.bodies.size(); ++i)
    if (const DynamicState& s = state_.bodies[i];
        bodies_.alive(i) && s.awake && !(s.force.isZero(0) && s.torque.isZero(0)))
      kept_.push_back({bodies_.handleOf(i), s.force, s.torque});
}

void WorldModel::repeatForces() {
  again_ = true;
  for (const KeptForce& k : kept_) {
    // A handler removed it, or it fell asleep, and would keep them.
    if (bodies_[k.body] == kNone || !of(k.body).awake) continue;
    of(k.body).force += k.force;
    of(k.body).torque += k.torque;
  }
}

void WorldModel::step(engine::IEngine& engine, engine::Contacts& contacts, double dt, engine::IContactSink* sink) {
  compact();
  engine::ISolver& solver = WorldModel::solver(engine);
  const engine::Capabilities can = engine.capabilities();
  ++steps_;
  const bool first = !std::exchange(again_, false);
  if (first) repaired_.clear();
  if (std::none_of(state_.bodies.begin(), state_.bodies.end(), [](const DynamicState& s) { return s.awake; })) return;
  // Sleep counts steps of the simulation.
  if (first && model_.parameters.autoDisable && can.sleeps) putToSleep(contacts, dt);
  if (!can.controls) applyControls();
  if (!can.damping && damped_) applyDamping();
  if (!can.springs && sprung_) applySprings();
  if (!can.bodyDamping && bodiesDamped_) applyBodyDamping(dt);
  if (turningAt_ != model_.structure) listTurning();
  if (countedAt_ != poses_) countTurns();  // poses were set since the last step
  engine::Step step{model_, state_, contacts, rounded(dt), {}, sink};
  if (can.late) step.contacts = {};
  solver.step(step);
  ++poses_;
  checkBodies();
  countTurns();
}

void WorldModel::checkBodies() {
  for (Index i = 0; i < state_.bodies.size(); ++i) {
    DynamicState& s = state_.bodies[i];
    if (!s.awake) continue;
    Watch& w = watch_[i];
    if (inRange(s.position) && inRange(s.quaternion.data(), 4) && inRange(s.linearVelocity) &&
        inRange(s.angularVelocity)) {
      w.validPosition = s.position;
      w.validQuaternion = s.quaternion;
      continue;
    }
    s.position = w.validPosition;
    s.quaternion = w.validQuaternion;
    s.rotation = rotationOf(s.quaternion);
    s.linearVelocity.setZero();
    s.angularVelocity.setZero();
    ++s.version;
    state_.markMoved(i);
    repaired_.push_back(bodies_.handleOf(i));
  }
}

}  // namespace spark::physics
