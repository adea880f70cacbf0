#include <algorithm>

#include "ode_engine.h"

namespace spark {

using namespace ode;
using engine::Contact;
using engine::Shape;

namespace {

/// Which of two geoms is the contact's first: one that can move before one that cannot, a plane always last, else the
/// younger. So a robot's foot comes before the ground and before what lies there, and handlers that only hear direct
/// contacts hear them.
bool comesFirst(const GeomData& a, const GeomData& b) {
  const auto rank = [](const GeomData& g) { return g.shape.shape == Shape::plane ? 0 : g.body ? 2 : 1; };
  const int ra = rank(a), rb = rank(b);
  return ra != rb ? ra > rb : a.age > b.age;
}

/// Planes and rays among themselves have nothing to say to each other.
bool meaningless(const GeomData& a, const GeomData& b) {
  const Shape s = a.shape.shape;
  return s == b.shape.shape && (s == Shape::plane || s == Shape::ray);
}

void near(void* world, dGeomID o1, dGeomID o2);

/// Exact replay: a space's own geoms are collided when it first meets something.
void collideInside(WorldData& w, dGeomID o) {
  if (!dGeomIsSpace(o)) return;
  SpaceData& s = *static_cast<SpaceData*>(dGeomGetData(o));
  if (!s.inner || s.collidedAt == w.steps + 1) return;
  s.collidedAt = w.steps + 1;
  dSpaceCollide(s.id, &w, near);
}

/// ODE's callback for two geoms, or spaces, whose bounds overlap.
void near(void* world, dGeomID o1, dGeomID o2) {
  WorldData& w = *static_cast<WorldData*>(world);
  if (dGeomIsSpace(o1) || dGeomIsSpace(o2)) {
    dSpaceCollide2(o1, o2, world, near);
    if (w.exactReplay) collideInside(w, o1), collideInside(w, o2);
    return;
  }
  auto* a = static_cast<GeomData*>(dGeomGetData(o1));
  auto* b = static_cast<GeomData*>(dGeomGetData(o2));
  if (meaningless(*a, *b)) return;
  if (a->body && b->body && a->body->joints > 0 && b->body->joints > 0 &&
      dAreConnectedExcluding(a->body->id, b->body->id, dJointTypeContact))
    return;
  if (!w.exactReplay && !comesFirst(*a, *b)) std::swap(a, b);
  if (w.filter && !w.filter(a->owner, b->owner)) return;
  w.pairs.push_back({a, b});
}

int collide(const Pair& pair, int most, dContactGeom* found) {
  if (pair.a->shape.shape != Shape::mesh && pair.b->shape.shape != Shape::mesh)
    return dCollide(pair.a->id, pair.b->id, most, found, sizeof(dContactGeom));
  const std::lock_guard lock(meshMutex());
  return dCollide(pair.a->id, pair.b->id, most, found, sizeof(dContactGeom));
}

}  // namespace

void OdeEngine::detect(engine::World world, engine::PairFilter filter, int perPair, engine::Contacts& out) {
  WorldData& w = *data(world);
  const Listening listening(said_);
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

  dContactGeom found[kMostPerPair];
  const int most = std::clamp(perPair, 1, kMostPerPair);
  for (const Pair& pair : w.pairs) {
    const int n = collide(pair, most, found);
    for (int i = 0; i < n; ++i) {
      const dContactGeom& g = found[i];
      // Degenerate shapes may give a normal of no direction.
      if (!sane(g.pos, 3) || !sane(g.normal, 3) || !sane(&g.depth, 1)) continue;
      Contact& c = out.emplace_back();
      c.geomA = engine::Geom{reinterpret_cast<std::uintptr_t>(pair.a)};
      c.geomB = engine::Geom{reinterpret_cast<std::uintptr_t>(pair.b)};
      c.ownerA = pair.a->owner;
      c.ownerB = pair.b->owner;
      c.position = toVec(g.pos);
      c.normal = toVec(g.normal);
      c.depth = g.depth;
    }
  }
  if (!said_.empty()) report();
}

}  // namespace spark
