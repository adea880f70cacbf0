#include "body_watch.h"

#include <algorithm>
#include <bit>

namespace spark::physics {

using engine::DynamicState;
using engine::Index;
using engine::kNone;

void BodyWatch::placed(Index body) {
  const DynamicState& s = world_.state.bodies[body];
  entries_[body].validPosition = s.position;
  entries_[body].validQuaternion = s.quaternion;
}

void BodyWatch::rouse(Index body) {
  if (world_.model.exactReplay || loading()) return;
  world_.state.bodies[body].awake = true;
  switched(body, true);
}

void BodyWatch::rouseAll() {
  for (Index i = 0; i < world_.state.bodies.size(); ++i) rouse(i);
}

void BodyWatch::switched(Index body, bool awake) {
  entries_[body].support = {};
  if (awake) entries_[body].counters = {};
  anyRests_ |= !awake;
}

void BodyWatch::loaded(Index body, const Counters& counters, const Support& support) {
  entries_[body].counters = counters;
  entries_[body].support = support;
  anyLoaded_ = anyRests_ = true;
  loaded_.push_back({body, world_.state.bodies[body].awake, counters, support});
}

void BodyWatch::settle() {
  for (const Loaded& l : loaded_) {
    world_.state.bodies[l.body].awake = l.awake;
    entries_[l.body].counters = l.counters;
    entries_[l.body].support = l.support;
  }
  loaded_.clear();
}

bool BodyWatch::takeLoaded() {
  loaded_.clear();
  return std::exchange(anyLoaded_, false);
}

namespace {

/// A number of what a contact does as a constraint, bit by bit. Sums of these are digests of several contacts, in
/// whatever order they are.
std::uint64_t digestOf(const engine::Contact& c) {
  const engine::Surface& s = c.surface;
  const double numbers[] = {c.position.x(), c.position.y(), c.position.z(), c.normal.x(), c.normal.y(),
                            c.normal.z(),   c.depth,        s.mu,           s.bounce,     s.bounceVelocity,
                            s.softErp,      s.softCfm,      s.slip1,        s.slip2};
  const auto folded = [](std::uint64_t w) { return w ^ (w >> 32); };  // round numbers have bits only at the top
  std::uint64_t sum = 1 + s.bounceOn + 2 * s.softErpOn + 4 * s.softCfmOn + 8 * s.slipOn + 16 * s.pyramid;
  // Odd factors that differ, so that no two numbers can change places; they do not depend on each other.
  std::uint64_t factor = 0xff51afd7ed558ccd;
  for (const double v : numbers) {
    sum += folded(std::bit_cast<std::uint64_t>(v)) * factor;
    factor = factor * 0x9e3779b97f4a7c15 + 2;
  }
  return folded(sum) * 0xc4ceb9fe1a85ec53;
}

}  // namespace

template <class Counts>
void BodyWatch::addDigests(const engine::Contacts& contacts, Counts&& counts) {
  for (const engine::Contact& c : contacts) {
    if (!c.solve) continue;
    const bool a = c.bodyA != kNone && counts(c.bodyA), b = c.bodyB != kNone && counts(c.bodyB);
    if (!a && !b) continue;
    const std::uint64_t digest = digestOf(c);
    if (a) entries_[c.bodyA].touching += digest;
    if (b) entries_[c.bodyB].touching += digest;
  }
}

void BodyWatch::wake(const engine::Contacts& contacts) {
  if (world_.model.exactReplay || !std::exchange(anyRests_, false)) return;
  std::vector<DynamicState>& bodies = world_.state.bodies;
  addDigests(contacts, [&](Index i) { return !bodies[i].awake; });
  for (Index i = 0; i < bodies.size(); ++i) {
    Entry& w = entries_[i];
    if (bodies[i].awake) {
      // Its island woke it. One that others only kept from falling asleep goes on with its counters.
      if (w.support.slept) w.counters = {};
      w.support.known = w.support.slept = false;
      continue;
    }
    anyRests_ = true;
    const std::uint64_t touching = std::exchange(w.touching, 0);
    if (w.support.known && w.support.digest != touching)
      rouse(i);
    else
      w.support = {touching, w.support.contacts, true, true};
  }
}

void BodyWatch::putToSleep(const engine::Contacts& contacts, double dt, bool late) {
  ++calls_;
  const auto touches = [this](Index body) {
    Entry& w = entries_[body];
    if (std::exchange(w.lastContact, calls_) != calls_) w.contacts = 0;
    ++w.contacts;
  };
  for (const engine::Contact& c : contacts) {
    if (!c.solve) continue;
    if (c.bodyA != kNone) touches(c.bodyA);
    if (c.bodyB != kNone) touches(c.bodyB);
  }
  constexpr double kIdleSpeedSquared = 0.01 * 0.01;  // (m/s)^2 and (rad/s)^2
  // In short steps gravity alone takes longer than ten of them to such a speed.
  const double leastIdle = world_.model.exactReplay ? 0 : 0.095;  // s
  constexpr double kLosing = 0.02;                                // s
  bool any = false;
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
    // What has just lost a contact may be about to fall.
    const std::uint32_t touching = w.lastContact == calls_ ? w.contacts : 0;
    if (!world_.model.exactReplay && std::exchange(w.support.contacts, touching) > touching)
      w.counters.idleTimeLeft = std::max(w.counters.idleTimeLeft, kLosing - leastIdle);
    if (w.counters.idleStepsLeft > 0 || w.counters.idleTimeLeft > -leastIdle) continue;
    s.awake = false;
    s.linearVelocity.setZero();
    s.angularVelocity.setZero();
    ++s.version;
    any = true;
  }
  anyRests_ |= any;
  if (!any || late || world_.model.exactReplay) return;
  // Those that fell asleep now rest on these contacts.
  const auto fell = [&](Index i) { return !world_.state.bodies[i].awake && !entries_[i].support.slept; };
  addDigests(contacts, fell);
  for (Index i = 0; i < world_.state.bodies.size(); ++i)
    if (fell(i)) {
      Entry& w = entries_[i];
      w.support = {std::exchange(w.touching, 0), w.support.contacts, true, false};
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
