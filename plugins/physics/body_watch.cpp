#include "body_watch.h"

namespace spark::physics {

using engine::DynamicState;
using engine::Index;
using engine::kNone;

void BodyWatch::placed(Index body) {
  const DynamicState& s = world_.state.bodies[body];
  entries_[body].validPosition = s.position;
  entries_[body].validQuaternion = s.quaternion;
}

void BodyWatch::putToSleep(const engine::Contacts& contacts, double dt) {
  ++calls_;
  for (const engine::Contact& c : contacts) {
    if (!c.solve) continue;
    if (c.bodyA != kNone) entries_[c.bodyA].lastContact = calls_;
    if (c.bodyB != kNone) entries_[c.bodyB].lastContact = calls_;
  }
  constexpr double kIdleSpeedSquared = 0.01 * 0.01;  // (m/s)^2 and (rad/s)^2
  for (Index i = 0; i < world_.state.bodies.size(); ++i) {
    DynamicState& s = world_.state.bodies[i];
    Entry& w = entries_[i];
    // A body without joints and contacts is in free flight: it does not fall asleep.
    if (!s.awake || (world_.model.bodies[i].joints == 0 && w.lastContact != calls_)) continue;
    if (dot(s.linearVelocity, s.linearVelocity) > kIdleSpeedSquared ||
        dot(s.angularVelocity, s.angularVelocity) > kIdleSpeedSquared) {
      w.counters = {};
      continue;
    }
    // Idle: asleep when both counters have run out.
    --w.counters.idleStepsLeft;
    w.counters.idleTimeLeft -= dt;
    if (w.counters.idleStepsLeft > 0 || w.counters.idleTimeLeft > 0) continue;
    s.awake = false;
    s.linearVelocity.setZero();
    s.angularVelocity.setZero();
    ++s.version;
  }
}

void BodyWatch::repair(std::vector<Index>& repaired) {
  for (Index i = 0; i < world_.state.bodies.size(); ++i) {
    DynamicState& s = world_.state.bodies[i];
    if (!s.awake) continue;
    Entry& w = entries_[i];
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
    world_.state.markMoved(i);
    repaired.push_back(i);
  }
}

}  // namespace spark::physics
