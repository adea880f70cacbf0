#include <algorithm>

#include "ode_engine.h"

namespace spark {

using namespace ode;
using engine::Contact;
using engine::Shape;

namespace {

/// True when `a` is the first geom of a contact with `b`: movable geoms come before static ones, planes come last;
/// among equals the younger comes first. So a robot's foot comes before the ground and before older objects on it, and
/// handlers that use only direct contacts get them.
bool comesFirst(const GeomData& a, const GeomData& b) {
  const auto rank = [](const GeomData& g) { return g.shape.shape == Shape::plane ? 0 : g.body ? 2 : 1; };
  const int ra = rank(a), rb = rank(b);
  return ra != rb ? ra > rb : a.age > b.age;
}

/// True for two planes or two rays, which have no contacts.
bool neverCollide(const GeomData& a, const GeomData& b) {
  const Shape s = a.shape.shape;
  return s == b.shape.shape && (s == Shape::plane || s == Shape::ray);
}

void near(void* world, dGeomID o1, dGeomID o2);

/// Exact replay: the geoms of a space are collided with each other when the space first overlaps something.
void collideInside(WorldData& w, dGeomID o) {
  if (!dGeomIsSpace(o)) return;
  SpaceData& s = *static_cast<SpaceData*>(dGeomGetData(o));
  if (!s.inner || s.collidedAt == w.steps + 1) return;
  s.collidedAt = w.steps + 1;
  dSpaceCollide(s.id, &w, near);
}

/// ODE's callback for two geoms or spaces whose bounds overlap: collects pairs of geoms.
void near(void* world, dGeomID o1, dGeomID o2) {
  WorldData& w = *static_cast<WorldData*>(world);
  if (dGeomIsSpace(o1) || dGeomIsSpace(o2)) {
    dSpaceCollide2(o1, o2, world, near);
    if (w.exactReplay) collideInside(w, o1), collideInside(w, o2);
    return;
  }
  auto* a = static_cast<GeomData*>(dGeomGetData(o1));
  auto* b = static_cast<GeomData*>(dGeomGetData(o2));
  if (neverCollide(*a, *b)) return;
  if (a->body && b->body && a->body->joints > 0 && b->body->joints > 0 &&
      dAreConnectedExcluding(a->body->id, b->body->id, dJointTypeContact))
    return;
  if (!w.exactReplay && !comesFirst(*a, *b)) std::swap(a, b);
  if (w.filter && !w.filter(a->owner, b->owner)) return;
  w.pairs.push_back({a, b});
}

/// Narrow phase: writes at most `max` contact points to `found` and returns their number.
int collide(const Pair& pair, int max, dContactGeom* found) {
  if (pair.a->shape.shape != Shape::mesh && pair.b->shape.shape != Shape::mesh)
    return dCollide(pair.a->id, pair.b->id, max, found, sizeof(dContactGeom));
  const std::lock_guard lock(meshMutex());
  return dCollide(pair.a->id, pair.b->id, max, found, sizeof(dContactGeom));
}

}  // namespace

void OdeEngine::detect(engine::World world, engine::PairFilter filter, int perPair, engine::Contacts& out) {
  WorldData& w = *data(world);
  const MessageCapture capture(odeMessage_);

  // Broad phase: the close pairs, in ODE's order (exact replay) or sorted by age.
  w.filter = filter;
  w.pairs.clear();
  if (w.exactReplay) {
    for (const auto& space : w.spaces)
      if (space->top) dSpaceCollide(space->id, &w, near);
  } else {
    if (dSpaceGetNumGeoms(w.root) > 1) dSpaceCollide(w.root, &w, near);
    for (const auto& space : w.spaces)
      if (space->inner) dSpaceCollide(space->id, &w, near);
    std::sort(w.pairs.begin(), w.pairs.end());
  }

  // Narrow phase.
  dContactGeom found[kMaxPerPair];
  const int max = std::clamp(perPair, 1, kMaxPerPair);
  for (const Pair& pair : w.pairs) {
    const int n = collide(pair, max, found);
    for (int i = 0; i < n; ++i) {
      const dContactGeom& g = found[i];
      // Degenerate shapes may give a normal that is not finite.
      if (!inRange(g.pos, 3) || !inRange(g.normal, 3) || !inRange(&g.depth, 1)) continue;
      Contact& c = out.emplace_back();
      c.geomA = handle(*pair.a);
      c.geomB = handle(*pair.b);
      c.ownerA = pair.a->owner;
      c.ownerB = pair.b->owner;
      c.position = toVec(g.pos);
      c.normal = toVec(g.normal);
      c.depth = g.depth;
    }
  }
  if (!odeMessage_.empty()) report();
}

}  // namespace spark
