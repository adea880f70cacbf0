#include "body_watch.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

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

void BodyWatch::loaded(Index body, const Counters& counters, const Support& support, const Start& start) {
  Entry& w = entries_[body];
  w.counters = counters;
  w.support = support;
  w.start = start;
  anyLoaded_ = anyRests_ = true;
  loaded_.push_back({body, world_.state.bodies[body].awake, counters, support, start});
}

void BodyWatch::settle() {
  for (const Loaded& l : loaded_) {
    world_.state.bodies[l.body].awake = l.awake;
    entries_[l.body].counters = l.counters;
    entries_[l.body].support = l.support;
    entries_[l.body].start = l.start;
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
  ready_.clear();
  for (Index i = 0; i < world_.state.bodies.size(); ++i) {
    const DynamicState& s = world_.state.bodies[i];
    Entry& w = entries_[i];
    // A body without joints and contacts is in free flight: it does not fall asleep.
    if (!s.awake || (world_.model.bodies[i].joints == 0 && w.lastContact != calls_)) continue;
    if (dot(s.linearVelocity, s.linearVelocity) > kIdleSpeedSquared ||
        dot(s.angularVelocity, s.angularVelocity) > kIdleSpeedSquared) {
      w.counters = {};
      continue;
    }
    // Idle: asleep when both counters have run out.
    if (w.counters.idleStepsLeft == Counters().idleStepsLeft) w.start = {s.position, s.quaternion};
    // It may stay idle and awake for ever, beside what is driven.
    if (w.counters.idleStepsLeft > std::numeric_limits<int>::min()) --w.counters.idleStepsLeft;
    w.counters.idleTimeLeft -= dt;
    // What has just lost a contact may be about to fall.
    const std::uint32_t touching = w.lastContact == calls_ ? w.contacts : 0;
    if (!world_.model.exactReplay && std::exchange(w.support.contacts, touching) > touching)
      w.counters.idleTimeLeft = std::max(w.counters.idleTimeLeft, kLosing - leastIdle);
    if (w.counters.idleStepsLeft <= 0 && w.counters.idleTimeLeft <= -leastIdle) ready_.push_back(i);
  }
  if (!ready_.empty() && !world_.model.exactReplay) keepDriven(contacts);
  for (const Index i : ready_) {
    DynamicState& s = world_.state.bodies[i];
    s.awake = false;
    s.linearVelocity.setZero();
    s.angularVelocity.setZero();
    ++s.version;
  }
  const bool any = !ready_.empty();
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

namespace {

/// True if a joint may move its bodies however slow they are. Damping and springs are only a reason to look twice: they
/// hold what is at rest, too.
bool drives(const engine::Joint& joint, const engine::Motors& motors) {
  for (std::size_t axis = 0; axis < joint.axes.size(); ++axis) {
    const engine::JointAxis& a = joint.axes[axis];
    const engine::Motor& m = motors[axis];
    if (a.damping > 0 || a.stiffness > 0 || (m.velocity != 0 && m.maxForce > 0)) return true;
  }
  return false;
}

}  // namespace

void BodyWatch::findDriven() {
  for (Index i = 0; i < entries_.size(); ++i) {
    const engine::Body& b = world_.model.bodies[i];
    entries_[i].driven = b.linearDamping > 0 || b.angularDamping > 0;
  }
  const auto drive = [this](Index a, Index b) {
    if (a != kNone) entries_[a].driven = true;
    if (b != kNone) entries_[b].driven = true;
  };
  const std::vector<engine::Joint>& joints = world_.model.joints;
  for (Index j = 0; j < joints.size(); ++j)
    if (drives(joints[j], world_.state.motors[j])) drive(joints[j].a, joints[j].b);
  for (const engine::AxisControl& c : world_.state.controls) drive(joints[c.joint].a, joints[c.joint].b);
}

bool BodyWatch::isStill(Index body) const {
  constexpr double kStillSpeed = 1e-5;  // m/s and rad/s, on average since it became idle
  const DynamicState& s = world_.state.bodies[body];
  const Entry& w = entries_[body];
  const double most = kStillSpeed * -w.counters.idleTimeLeft;
  // The vector of a small rotation is half its angle.
  const Quaternion turn = timesConjugate(s.quaternion, w.start.quaternion);
  const Vec3 half(turn[1], turn[2], turn[3]), moved = s.position - w.start.position;
  return dot(moved, moved) <= most * most && 4 * dot(half, half) <= most * most;
}

void BodyWatch::keepDriven(const engine::Contacts& contacts) {
  findDriven();
  std::vector<DynamicState>& bodies = world_.state.bodies;
  bool any = false;
  auto ready = ready_.begin();
  for (Index i = 0; i < bodies.size(); ++i) {
    Entry& w = entries_[i];
    const bool isReady = ready != ready_.end() && *ready == i;
    if (isReady) ++ready;
    if (!w.driven) continue;
    w.driven = bodies[i].awake && !(isReady && isStill(i));  // and moves
    if (w.driven && isReady) w.counters = {};
    any |= w.driven;
  }
  if (!any) return;
  root_.resize(bodies.size());
  std::iota(root_.begin(), root_.end(), Index{0});
  const auto find = [this](Index i) {
    while (root_[i] != i) i = root_[i] = root_[root_[i]];
    return i;
  };
  const auto unite = [&](Index a, Index b) {
    if (a != kNone && b != kNone) root_[find(a)] = find(b);
  };
  for (const engine::Joint& j : world_.model.joints) unite(j.a, j.b);
  for (const engine::Contact& c : contacts)
    if (c.solve) unite(c.bodyA, c.bodyB);
  for (Index i = 0; i < bodies.size(); ++i)
    if (entries_[i].driven) entries_[find(i)].driven = true;
  std::erase_if(ready_, [&](Index i) { return entries_[find(i)].driven; });
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
