#include "contact_loop.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace spark::physics {
namespace {

/// Combines one parameter of two surfaces: the mean if both have it switched on, else that of the one which has.
void mix(bool& on, double& value, bool onA, double a, bool onB, double b) {
  on = onA || onB;
  value = onA && onB ? (a + b) / 2 : onA ? a : onB ? b : 0;
}

const engine::Surface* surfaceOf(const Collider::Handlers& h) {
  return h.contact ? h.contact->surface() : h.fallback ? &defaultSurface() : nullptr;
}

/// One past the last of the contact points from `i` on that belong to the same pair.
std::size_t endOfPair(const engine::Contacts& contacts, std::size_t i) {
  std::size_t end = i + 1;
  while (end < contacts.size() && contacts[end].geomA == contacts[i].geomA && contacts[end].geomB == contacts[i].geomB)
    ++end;
  return end;
}

}  // namespace

engine::Surface combine(const engine::Surface& a, const engine::Surface& b) {
  engine::Surface s;
  // A coefficient and a force have no mean: the coefficient counts.
  s.pyramid = a.pyramid || b.pyramid;
  s.mu = a.pyramid == b.pyramid ? (a.mu + b.mu) / 2 : a.pyramid ? a.mu : b.mu;
  mix(s.bounceOn, s.bounce, a.bounceOn, a.bounce, b.bounceOn, b.bounce);
  mix(s.bounceOn, s.bounceVelocity, a.bounceOn, a.bounceVelocity, b.bounceOn, b.bounceVelocity);
  mix(s.softErpOn, s.softErp, a.softErpOn, a.softErp, b.softErpOn, b.softErp);
  mix(s.softCfmOn, s.softCfm, a.softCfmOn, a.softCfm, b.softCfmOn, b.softCfm);
  mix(s.slipOn, s.slip1, a.slipOn, a.slip1, b.slipOn, b.slip1);
  mix(s.slipOn, s.slip2, a.slipOn, a.slip2, b.slipOn, b.slip2);
  return s;
}

bool pairCounts(void* ownerA, void* ownerB) {
  const Collider& a = *static_cast<const Collider*>(ownerA);
  const Collider& b = *static_cast<const Collider*>(ownerB);
  const bool solid = a.solid() && b.solid() && (a.hasBody() || b.hasBody());
  return (solid || a.listens() || b.listens()) && a.mayCollideWith(b);
}

void decide(std::span<engine::Contact> pair) {
  const Collider& a = *static_cast<const Collider*>(pair.front().ownerA);
  const Collider& b = *static_cast<const Collider*>(pair.front().ownerB);
  if (!a.solid() || !b.solid() || (!a.hasBody() && !b.hasBody())) return;
  // All points of a solid pair share one surface.
  const engine::Surface &ofA = *surfaceOf(a.handlers()), &ofB = *surfaceOf(b.handlers());
  const engine::Surface surface = a.priority() == b.priority()  ? combine(ofA, ofB)
                                  : a.priority() > b.priority() ? ofA
                                                                : ofB;
  for (engine::Contact& c : pair) {
    c.solve = true;
    c.surface = surface;
  }
}

void sortByPair(engine::Contacts& contacts, const engine::Model& model, std::vector<std::size_t>& order,
                engine::Contacts& sorted) {
  const auto key = [&](std::size_t i) {
    return std::tuple(model.geoms[contacts[i].geomA].id, model.geoms[contacts[i].geomB].id, i);
  };
  order.resize(contacts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return key(x) < key(y); });
  sorted.clear();
  for (const std::size_t i : order) sorted.push_back(contacts[i]);
  contacts.swap(sorted);
}

void runHandlers(engine::Contacts& contacts, Kernel& kernel, bool decided) {
  const std::uint64_t version = kernel.structureVersion();
  for (std::size_t i = 0, end; i < contacts.size(); i = end) {
    end = endOfPair(contacts, i);
    Collider& a = *static_cast<Collider*>(contacts[i].ownerA);
    Collider& b = *static_cast<Collider*>(contacts[i].ownerB);

    if (!decided) decide({&contacts[i], end - i});
    if (!a.listens() && !b.listens()) continue;
    for (std::size_t k = i; k < end; ++k) {
      for (CollisionHandler* h : a.handlers().active) h->onCollision({a, b, contacts[k], true});
      for (CollisionHandler* h : b.handlers().active) h->onCollision({b, a, contacts[k], false});
    }
    if (kernel.structureVersion() == version) continue;
    kernel.log().error(
        "a collision handler of {} or {} changed the tree while contacts were handled; this step has no contacts. "
        "Change it in another phase.",
        a.path(), b.path());
    contacts.clear();
    return;
  }
}

void measure(engine::Contacts& contacts, std::vector<std::size_t>& added) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!contacts[i].solve || contacts[i].feedback) continue;
    contacts[i].feedback = true;
    added.push_back(i);
  }
}

void runSolved(engine::Contacts& contacts, int steps) {
  // From last to first: sensors sum forces in single precision, and this order gives the digits of the installed base.
  for (std::size_t i = contacts.size(); i-- > 0;) {
    engine::Contact& c = contacts[i];
    if (!c.feedback) continue;
    Collider& a = *static_cast<Collider*>(c.ownerA);
    Collider& b = *static_cast<Collider*>(c.ownerB);
    const Vec3 force = c.forceOnA;
    if (steps > 1) c.forceOnA /= steps;
    for (CollisionHandler* h : a.handlers().active) h->onSolved({a, b, c, true});
    for (CollisionHandler* h : b.handlers().active) h->onSolved({b, a, c, false});
    c.forceOnA = force;
  }
}

}  // namespace spark::physics
