#include "ode_collision.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "api/joined_bodies.h"
#include "api/physics.h"
#include "spark/prefetch.h"

namespace spark::ode {

using engine::Contact;
using engine::Index;
using engine::kNone;
using engine::Model;
using engine::Shape;
using engine::State;

namespace {

/// Upper limit of contact points per pair of geoms, whatever detect() is called with.
constexpr int kMaxPerPair = 16;

// ---- shapes and poses ----

/// Creates ODE's geom for g.shape.
void createShape(GeomData& g, dSpaceID space, MadeShapes& made) {
  g.geom = createGeom(g.shape, space, made, g.shared);
  dGeomSetData(g.geom, &g);
  // ODE's getter returns a pointer into the geom, which stays valid as long as it lives.
  g.rotation = g.shape.shape == Shape::plane ? nullptr : const_cast<dReal*>(dGeomGetRotation(g.geom));
}

/// Writes a pose to ODE's geom, without change of a bit, and marks it as moved.
void setPose(const GeomData& g, const Vec3& position, const Mat3& rotation) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) g.rotation[4 * row + column] = rotation(row, column);
  dGeomSetPosition(g.geom, position.x(), position.y(), position.z());
}

/// Brings a geom to its body, or to its place in the world. Sums are from left to right, as in ODE.
void place(const GeomData& g, const State& state) {
  if (!g.rotation) return;  // a plane is given in the world frame
  if (g.body == kNone) return setPose(g, g.offset.position, g.offset.rotation);
  const engine::DynamicState& b = state.bodies[g.body];
  if (g.centred) return setPose(g, b.position, b.rotation);
  const Mat3& r = b.rotation;
  const Vec3& p = g.offset.position;
  const Mat3& o = g.offset.rotation;
  Vec3 position;
  Mat3 rotation;
  for (int i = 0; i < 3; ++i) {
    position[i] = r(i, 0) * p[0] + r(i, 1) * p[1] + r(i, 2) * p[2] + b.position[i];
    for (int j = 0; j < 3; ++j) rotation(i, j) = r(i, 0) * o(0, j) + r(i, 1) * o(1, j) + r(i, 2) * o(2, j);
  }
  setPose(g, position, rotation);
}

/// Takes body and offset from the model.
void takePlace(GeomData& g, const engine::Geom& from) {
  g.body = from.body;
  g.offset = compose(from.offset, frameOf(g.shape, g.shared));
  g.centred = g.body != kNone && g.offset.position.isZero(0) && g.offset.rotation.isIdentity(0);
}

void setCollides(GeomData& g, bool on) {
  if (std::exchange(g.collides, on) == on) return;
  on ? dGeomEnable(g.geom) : dGeomDisable(g.geom);
}

}  // namespace

// ---- worlds ----

CollisionWorld::CollisionWorld(bool replay) : exactReplay(replay), root(dHashSpaceCreate(nullptr)) {
  dSpaceSetCleanup(root, 0);
}

CollisionWorld::~CollisionWorld() {
  for (const auto& g : geoms) destroyGeom(g->geom);
  // From the last: inner spaces were created after the spaces around them.
  for (auto s = spaces.rbegin(); s != spaces.rend(); ++s) dSpaceDestroy((*s)->space);
  dSpaceDestroy(root);
}

bool CollisionWorld::joined(Index a, Index b) const {
  const auto first = joinedTo.begin() + firstJoined[a], last = joinedTo.begin() + firstJoined[a + 1];
  return std::binary_search(first, last, b);
}

namespace {

void createSpace(CollisionWorld& w, const Model& model, Index index) {
  const engine::Space& from = model.spaces[index];
  auto s = std::make_unique<SpaceData>();
  s->id = from.id;
  s->top = w.exactReplay && from.parent == kNone;
  const dSpaceID around = s->top ? nullptr : from.parent == kNone ? w.root : w.spaces[from.parent]->space;
  // ODE's sweep-and-prune spaces do not compute their own bounds: inside another space they would overlap everything.
  const bool sweepAndPrune = !w.exactReplay && from.parent == kNone;
  s->space = sweepAndPrune ? dSweepAndPruneSpaceCreate(around, dSAP_AXES_XYZ) : dHashSpaceCreate(around);
  dSpaceSetCleanup(s->space, 0);
  dGeomSetData(reinterpret_cast<dGeomID>(s->space), s.get());
  w.spaces.push_back(std::move(s));
}

void addGeom(CollisionWorld& w, const Model& model, const State& state, Index index) {
  const engine::Geom& from = model.geoms[index];
  auto g = std::make_unique<GeomData>();
  g->id = from.id;
  g->owner = from.owner;
  g->shape = from.shape;
  createShape(*g, w.spaces[from.space]->space, w.made);
  takePlace(*g, from);
  place(*g, state);
  setCollides(*g, from.collides);
  w.geoms.push_back(std::move(g));
}

/// Lists the geoms of each body, and the bodies that joints connect it to.
void listByBody(CollisionWorld& w, const Model& model) {
  const std::size_t n = model.bodies.size();
  // A counting sort; `first` is shifted by one, so that filling the list moves it to its final place.
  const auto sortByBody = [n](std::vector<Index>& first, std::vector<Index>& list, auto forEach) {
    first.assign(n + 2, 0);
    forEach([&](Index body, Index) { ++first[body + 2]; });
    for (std::size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];
    list.resize(first.back());
    forEach([&](Index body, Index element) { list[first[body + 1]++] = element; });
  };
  sortByBody(w.firstGeom, w.geomsOf, [&](auto visit) {
    // The youngest first, as a body of ODE has its geoms.
    for (auto g = static_cast<Index>(model.geoms.size()); g-- > 0;)
      if (model.geoms[g].body != kNone) visit(model.geoms[g].body, g);
  });
  sortByBody(w.firstJoined, w.joinedTo,
             [&](auto visit) { engine::forEachJoined(model, [&](Index a, Index b) { visit(a, b), visit(b, a); }); });
  for (std::size_t i = 0; i < n; ++i)
    std::sort(w.joinedTo.begin() + w.firstJoined[i], w.joinedTo.begin() + w.firstJoined[i + 1]);
}

/// Gives the geoms the new poses of the bodies that moved.
void followBodies(const CollisionWorld& w, const State& state) {
  constexpr std::size_t kAhead = 6;  // prefetch distance [bodies]
  for (std::size_t k = 0; k < state.moved.size(); ++k) {
    if (k + kAhead < state.moved.size())
      if (const Index far = state.moved[k + kAhead]; w.firstGeom[far] < w.firstGeom[far + 1])
        prefetch(w.geoms[w.geomsOf[w.firstGeom[far]]].get(), sizeof(GeomData) / 2);
    const Index i = state.moved[k];
    for (Index g = w.firstGeom[i]; g < w.firstGeom[i + 1]; ++g) place(*w.geoms[w.geomsOf[g]], state);
  }
}

}  // namespace

namespace {
/// Brings all geoms into the order that was loaded, as ODE would have it now.
void restoreOrder(CollisionWorld& w, const State& state) {
  const CollisionWorld::Order order = *std::exchange(w.loaded, std::nullopt);
  if (order.spaces.size() != w.spaces.size()) return;  // the world was changed since
  const auto clean = [&w] {
    for (const auto& s : w.spaces) dSpaceClean(s->space);
  };
  clean();
  // Inner spaces first: a change of one may move it in the space around it. One geom at a time, so that ODE never has
  // one that is not clean behind one that is.
  for (std::size_t s = w.spaces.size(); s-- > 0;) {
    const dSpaceID space = w.spaces[s]->space;
    for (auto g = order.spaces[s].rbegin(); g != order.spaces[s].rend(); ++g) {
      dSpaceRemove(space, *g);
      dSpaceAdd(space, *g);
      clean();
    }
  }
  // What is clean comes to the front when it moves.
  for (const Index i : order.moved)
    for (Index g = w.firstGeom[i]; g < w.firstGeom[i + 1]; ++g) place(*w.geoms[w.geomsOf[g]], state);
}

/// True if nothing was removed since compile().
bool isAsBuilt(const CollisionWorld& w, const Model& model) {
  return std::all_of(w.geoms.begin(), w.geoms.end(), [&](const auto& g) {
    return g->index < model.geoms.size() && model.geoms[g->index].id == g->id && model.geoms[g->index].body == g->body;
  });
}
}  // namespace

void OdeDetector::compile(const Model& model, const State& state, std::span<const Index> edited) {
  const MessageCapture capture(node_.messages_.last);
  CollisionWorld& w = world_;
  // The order that was loaded is that of the elements of then.
  if (w.loaded && isAsBuilt(w, model)) restoreOrder(w, state);
  w.loaded.reset();

  // Removed elements; inner spaces before the spaces around them.
  std::erase_if(w.geoms, [&](const auto& g) {
    if (engine::indexOf(model.geoms, g->id) != kNone) return false;
    destroyGeom(g->geom);
    return true;
  });
  for (std::size_t i = w.spaces.size(); i-- > 0;) {
    if (engine::indexOf(model.spaces, w.spaces[i]->id) != kNone) continue;
    dSpaceDestroy(w.spaces[i]->space);
    w.spaces.erase(w.spaces.begin() + static_cast<std::ptrdiff_t>(i));
  }

  const bool restructured = w.builtAt != model.structure;
  const auto oldGeoms = static_cast<Index>(w.geoms.size());
  // New spaces and geoms, in order of creation.
  while (w.spaces.size() < model.spaces.size() || w.geoms.size() < model.geoms.size()) {
    const auto space = static_cast<Index>(w.spaces.size()), geom = static_cast<Index>(w.geoms.size());
    if (geom == model.geoms.size() || (space < model.spaces.size() && model.spaces[space].id < model.geoms[geom].id))
      createSpace(w, model, space);
    else
      addGeom(w, model, state, geom);
  }
  for (Index i = 0; i < model.spaces.size(); ++i) w.spaces[i]->inner = model.spaces[i].inner;

  if (restructured) {
    for (Index i = 0; i < w.geoms.size(); ++i) {
      GeomData& g = *w.geoms[i];
      g.index = i;
      g.body = model.geoms[i].body;
      g.jointed = g.body != kNone && model.bodies[g.body].joints > 0;
    }
    w.builtAt = model.structure;
  }
  // Changed ones.
  for (const Index i : edited) {
    if (i >= oldGeoms) continue;
    GeomData& g = *w.geoms[i];
    const engine::Geom& from = model.geoms[i];
    if (!engine::isSame(g.shape, from.shape)) {
      if (reshape(g.geom, g.shape, from.shape)) {
        g.shape = from.shape;
      } else {
        destroyGeom(g.geom);
        g.shape = from.shape;
        createShape(g, w.spaces[from.space]->space, w.made);
        if (!g.collides) dGeomDisable(g.geom);
      }
    }
    takePlace(g, from);
    g.jointed = g.body != kNone && model.bodies[g.body].joints > 0;
    place(g, state);
    setCollides(g, from.collides);
  }
  if (restructured || !edited.empty()) listByBody(w, model);
  node_.messages_.report(node_);
}

// ---- exact replay ----

// In a space of ODE what moved last comes first: the order of its geoms depends on all that moved before, and the order
// of contacts on it. So it is state.

void OdeDetector::save(const State& state, StateWriter& out) const {
  const CollisionWorld& w = world_;
  if (!w.exactReplay) return;
  for (const auto& s : w.spaces) {
    const int count = dSpaceGetNumGeoms(s->space);
    out.write(count);
    for (int i = 0; i < count; ++i) {
      const dGeomID g = dSpaceGetGeom(s->space, i);
      if (!dGeomIsSpace(g)) {
        out.write(static_cast<std::int64_t>(static_cast<const GeomData*>(dGeomGetData(g))->index));
        continue;
      }
      const auto inner = std::find_if(w.spaces.begin(), w.spaces.end(),
                                      [&](const auto& other) { return other.get() == dGeomGetData(g); });
      out.write(-1 - (inner - w.spaces.begin()));  // below 0: a space
    }
  }
  out.write(static_cast<std::int64_t>(state.moved.size()));
  for (const Index i : state.moved) out.write(static_cast<std::int64_t>(i));
}

void OdeDetector::load(const Model& model, const State&, StateReader& in) {
  CollisionWorld& w = world_;
  if (!w.exactReplay) return;
  const auto expect = [](bool good) {
    if (!good) throw Error("the saved order of contacts is that of another world");
  };
  CollisionWorld::Order order;
  for (const auto& s : w.spaces) {
    std::vector<dGeomID>& geoms = order.spaces.emplace_back(in.readCount());
    expect(static_cast<int>(geoms.size()) == dSpaceGetNumGeoms(s->space));
    for (dGeomID& g : geoms) {
      const std::int64_t i = in.readInteger(), space = -1 - i;
      expect(i < std::ssize(w.geoms) && space < std::ssize(w.spaces));
      g = i < 0 ? reinterpret_cast<dGeomID>(w.spaces[static_cast<std::size_t>(space)]->space)
                : w.geoms[static_cast<std::size_t>(i)]->geom;
      expect(dSpaceQuery(s->space, g) != 0);
    }
  }
  order.moved.resize(in.readCount());
  for (Index& i : order.moved) {
    i = static_cast<Index>(in.readInteger());
    expect(i < model.bodies.size());
  }
  w.loaded = std::move(order);
}

// ---- detection ----

namespace {

/// True for two planes or two rays, which have no contacts, and for two geoms of one body.
bool neverCollide(const GeomData& a, const GeomData& b) {
  const Shape s = a.shape.shape;
  return (a.body == b.body && a.body != kNone) || (s == b.shape.shape && (s == Shape::plane || s == Shape::ray));
}

/// What ODE's callback needs.
struct Detection {
  CollisionWorld& w;
  engine::PairFilter filter;
};

void near(void* detection, dGeomID o1, dGeomID o2);

/// Exact replay: the geoms of a space are collided with each other when the space first overlaps something.
void collideInside(Detection& d, dGeomID o) {
  if (!dGeomIsSpace(o)) return;
  SpaceData& s = *static_cast<SpaceData*>(dGeomGetData(o));
  if (!s.inner || s.collidedAt == d.w.detections) return;
  s.collidedAt = d.w.detections;
  dSpaceCollide(s.space, &d, near);
}

/// ODE's callback for two geoms or spaces whose bounds overlap: collects pairs of geoms.
void near(void* detection, dGeomID o1, dGeomID o2) {
  Detection& d = *static_cast<Detection*>(detection);
  if (dGeomIsSpace(o1) || dGeomIsSpace(o2)) {
    dSpaceCollide2(o1, o2, detection, near);
    if (d.w.exactReplay) collideInside(d, o1), collideInside(d, o2);
    return;
  }
  auto* a = static_cast<GeomData*>(dGeomGetData(o1));
  auto* b = static_cast<GeomData*>(dGeomGetData(o2));
  if (neverCollide(*a, *b)) return;
  if (a->jointed && b->jointed && d.w.joined(a->body, b->body)) return;
  if (!d.w.exactReplay && !engine::comesFirst(*a, *b)) std::swap(a, b);
  if (d.filter && !d.filter(a->owner, b->owner)) return;
  d.w.pairs.push_back({a, b});
}

PlacedShape placed(const GeomData& g) {
  return {g.shape, g.shared.hull ? &g.shared.hull->hull() : nullptr, toVec(dGeomGetPosition(g.geom)),
          toMat(g.rotation)};
}

/// Degenerate shapes may give numbers that are not finite; faces that touch exactly, without depth, no normal.
bool isContact(const dContactGeom& g) {
  const double normal = toVec(g.normal).squaredNorm();
  return toVec(g.pos).allFinite() && std::isfinite(g.depth) && normal > 0.5 && normal < 2;
}

void turnNormals(int count, dContactGeom* found) {
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) found[i].normal[k] = -found[i].normal[k];
}

/// Contacts of a pair with a convex hull.
int collideConvex(const GeomData& a, const GeomData& b, int max, ConvexContacts& contacts, dContactGeom* found) {
  const bool second = a.shape.shape != Shape::convex;
  const GeomData &hull = second ? b : a, &other = second ? a : b;
  const auto ask = [&](int most) {
    const dGeomID o1 = hull.shared.hull->probeAt(hull.geom, 0);
    const dGeomID o2 = other.shared.hull ? other.shared.hull->probeAt(other.geom, 1) : other.geom;
    return dCollide(o1, o2, most, found, sizeof(dContactGeom));
  };
  int count = 0;
  switch (other.shape.shape) {
    case Shape::plane: {
      dVector4 plane;
      dGeomPlaneGetParams(other.geom, plane);
      count = contacts.onPlane(placed(hull), toVec(plane), plane[3], max, found);
      break;
    }
    case Shape::mesh: {
      // ODE finds those of this order alone, triangle by triangle.
      const std::lock_guard lock(meshMutex());
      count = other.body == kNone ? contacts.onMesh(placed(hull), hull.shared.hull->probe(),
                                                    other.shared.mesh->sidesAt(other.geom), max, found)
                                  : contacts.choose(ask(kMaxPerPair), max, found);
      break;
    }
    case Shape::heightField:
      count = contacts.choose(ask(kMaxPerPair), max, found);
      break;
    case Shape::ray:
      count = ask(max);
      break;
    default:
      count = ask(1);
      if (count > 0 && isContact(found[0])) count = contacts.spread(placed(hull), placed(other), max, found);
  }
  if (second) turnNormals(count, found);
  return count;
}

/// Contacts of a cylinder with a static mesh.
int collideOnMesh(GeomData& cylinder, const GeomData& mesh, int max, ConvexContacts& contacts, dContactGeom* found) {
  if (!cylinder.shared.prism) cylinder.shared.prism = prismAround(cylinder.shape);
  const std::lock_guard lock(meshMutex());
  return contacts.onMesh(placed(cylinder), cylinder.shared.prism->probe(), mesh.shared.mesh->sidesAt(mesh.geom), max,
                         found);
}

bool isStaticMesh(const GeomData& g) { return g.shape.shape == Shape::mesh && g.body == kNone; }

/// Narrow phase: writes at most `max` contact points to `found`, which has room for kMaxPerPair, and returns their
/// number.
int collide(const Pair& pair, int max, CollisionWorld& w, dContactGeom* found) {
  const Shape a = pair.a->shape.shape, b = pair.b->shape.shape;
  if (a == Shape::convex || b == Shape::convex) return collideConvex(*pair.a, *pair.b, max, w.convex, found);
  if (!w.exactReplay && a == Shape::cylinder && isStaticMesh(*pair.b))
    return collideOnMesh(*pair.a, *pair.b, max, w.convex, found);
  if (!w.exactReplay && b == Shape::cylinder && isStaticMesh(*pair.a)) {
    const int count = collideOnMesh(*pair.b, *pair.a, max, w.convex, found);
    turnNormals(count, found);
    return count;
  }
  if (a != Shape::mesh && b != Shape::mesh)
    return dCollide(pair.a->geom, pair.b->geom, max, found, sizeof(dContactGeom));
  const std::lock_guard lock(meshMutex());
  return dCollide(pair.a->geom, pair.b->geom, max, found, sizeof(dContactGeom));
}

}  // namespace

std::string OdeDetector::nameOf(const GeomData& geom) const {
  const IPhysicsServer* server = nullptr;
  if (Node* const parent = node_.parent()) server = parent->as<IPhysicsServer>();
  return server && geom.owner ? server->colliderOf(geom.owner).leaf().path() : fmt::format("geom {}", geom.id);
}

int OdeDetector::collideOrFail(const Pair& pair, int max, dContactGeom* found) {
  try {
    return collide(pair, max, world_, found);
  } catch (const Failure& failure) {
    node_.messages_.fail(node_, failure.what(),
                         fmt::format("{} and {} do not touch in this step", nameOf(*pair.a), nameOf(*pair.b)));
    return 0;
  }
}

void OdeDetector::detect(const Model&, const State& state, engine::PairFilter filter, int perPair,
                         engine::Contacts& out) {
  CollisionWorld& w = world_;
  const MessageCapture capture(node_.messages_.last);
  followBodies(w, state);
  if (w.loaded) restoreOrder(w, state);

  // Broad phase: the close pairs, in ODE's order (exact replay) or sorted by age.
  ++w.detections;
  w.pairs.clear();
  Detection detection{w, filter};
  if (w.exactReplay) {
    for (const auto& space : w.spaces)
      if (space->top) dSpaceCollide(space->space, &detection, near);
  } else {
    if (dSpaceGetNumGeoms(w.root) > 1) dSpaceCollide(w.root, &detection, near);
    for (const auto& space : w.spaces)
      if (space->inner) dSpaceCollide(space->space, &detection, near);
    std::sort(w.pairs.begin(), w.pairs.end());
  }

  // Narrow phase.
  dContactGeom found[kMaxPerPair];
  const int max = std::clamp(perPair, 1, kMaxPerPair);
  for (const Pair& pair : w.pairs) {
    const int n = collideOrFail(pair, max, found);
    for (int i = 0; i < n; ++i) {
      const dContactGeom& g = found[i];
      if (!isContact(g)) continue;
      Contact& c = out.emplace_back();
      c.geomA = pair.a->index;
      c.geomB = pair.b->index;
      c.bodyA = pair.a->body;
      c.bodyB = pair.b->body;
      c.ownerA = pair.a->owner;
      c.ownerB = pair.b->owner;
      c.position = toVec(g.pos);
      c.normal = toVec(g.normal);
      c.depth = g.depth;
    }
  }
  node_.messages_.report(node_);
}

}  // namespace spark::ode
