#include "physics_server.h"

#include <algorithm>
#include <functional>

#include "api/phases.h"
#include "api/snapshots.h"
#include "colliders.h"
#include "contact_loop.h"
#include "queries.h"
#include "spark/prefetch.h"

namespace spark {

void PhysicsServer::describe(Description<PhysicsServer>& d) {
  using S = PhysicsServer;
  d.doc("Steps the world of a scene with the engine below it.");
  d.implements<IPhysicsServer>();
  d.implements<IHearing>();
  d.link(&S::scenes_, At<ISceneServer>());
  d.link(&S::engine_, Child<engine::IEngine>());
  d.link(&S::collision_, Child<engine::ICollision>());
  d.property("scene", &S::scenePath, &S::setScene)
      .doc("Path of the scene whose world it steps; empty: the active one. Set it before the world is made.");
  d.property("jointHeating", &S::jointHeating_).doc("Modelled motors change their temperature.");
  d.property("batteryDischarge", &S::batteryDischarge_).doc("Modelled motors drain their batteries.");
  d.property("defaultHandlerOnTransformCollider", &S::defaultOnTransform, &S::setDefaultOnTransform)
      .doc(
          "A TransformCollider without a handler of its own has the default, bouncy surface, whatever handlers its "
          "inner "
          "collider has; false: it takes over those handlers.");
  d.property("measureForces", &S::measureForces_)
      .doc(
          "Measures the force of every solved contact, for plugins that read contacts. The last digits of the dense "
          "solver's results may differ from a run without.");
  d.property("exactReplay", &S::exactReplay_)
      .doc(
          "Worlds made from now on repeat recorded sessions of the installed base to the last digit, with that base's "
          "engine and collision detection: numbers that enter them are rounded to single precision, contacts are "
          "solved in the order in which its spaces report them, and bodies that sleep do not notice what changes "
          "around them.");
  d.property("contactsPerPair", &S::contactsPerPair_)
      .range(1, 16)
      .doc("Maximum number of contact points of two colliders.");
  d.method("settle", &S::settle).doc("Moves the origins of bodies to their centres of mass, as the next step would.");
  d.method("castRay", &S::rayFor)
      .parameters({"from [m]", "direction", "length [m]"})
      .doc(
          "What a ray meets first, in the world frame: { distance, path of the collider, position, normal of the "
          "surface }; nil: nothing within that length.");
  d.method("boundingBox", &S::boxOf)
      .parameters({"node"})
      .doc(
          "Two corners of the box along the world's axes around all that collides at a node and below it, { low, high "
          "} "
          "in m; planes do not count; nil: there is nothing.");
  d.on<&PhysicsServer::physics>(phase::kPhysics);
  d.on<&PhysicsServer::place>(phase::kPlace);
  d.on<&PhysicsServer::restored>(kRestored);
}

void PhysicsServer::expectEngines() const {
  const auto expect = [&](bool found, const char* what, const char* name, const char* interface) {
    if (found) return;
    // The first class that would do, as an example.
    for (ClassObject* c : kernel().classes())
      if (!c->isAbstract() && c->isOrOffers(interface))
        throw Error(fmt::format("{0} has no {1} below it: add one, for instance new(\"{3}\", \"{0}/{2}\")", path(),
                                what, name, c->name()));
    throw Error(fmt::format("{0} has no {1} below it: load a plugin with one ({2}), and add it as {0}/{3}", path(),
                            what, interface, name));
  };
  expect(static_cast<bool>(engine_), "engine", "engine", "IEngine");
  expect(collision_ || engine_->capabilities().findsContacts(), "collision detection", "collision", "ICollision");
}

Node* PhysicsServer::scene() {
  if (!scenePath_.empty()) return kernel().root().find<Node>(scenePath_);
  return scenes_ ? scenes_->activeScene() : find<Node>(ISceneServer::kDefaultScene);
}

bool PhysicsServer::isOf(const Node& scene) {
  return scenePath_.empty() ? &scene == this->scene() : scene.path() == scenePath_;
}

void PhysicsServer::setScene(std::string path) {
  scenePath_ = std::move(path);
  tree_.lookAgain();
}

World* PhysicsServer::findWorld() {
  Node* const at = scene();
  auto* world = at ? at->childOf<World>() : nullptr;
  return world && world->model() ? world : nullptr;
}

physics::WorldModel& PhysicsServer::expectWorld() {
  if (World* w = currentWorld()) return *w->model();
  throw Error(fmt::format("{}: the active scene has no world: make one, new(\"World\", \"/usr/scene/world\")", path()));
}

void PhysicsServer::bodies(Node& root, std::vector<IRigidBody*>& out) {
  if (auto self = root.as<IRigidBody>()) out.push_back(self);
  root.collect(out);
}

void PhysicsServer::setDefaultOnTransform(bool on) {
  defaultOnTransform_ = on;
  tree_.lookAgain();
}

void PhysicsServer::collect(const Node& scene) {
  // Bodies and colliders of this world, in tree order.
  std::vector<PhysicsObject*> objects;
  std::vector<CollisionGroup*> groups;
  scene.collect(objects);
  for (PhysicsObject* object : objects) {
    if (auto body = object->as<RigidBody>()) {
      if (body->transform() && body->world() == world_->model())
        bodies_.push_back({body, body->transform(), body->transform()->transform(), 0, engine::kNone});
    } else if (auto collider = object->as<Collider>()) {
      collider->refreshHandlers(defaultOnTransform_);
      collider->setGroup(nullptr);
      effects_.colliders.push_back(collider);
    } else if (auto group = object->as<CollisionGroup>()) {
      groups.push_back(group);
    } else if (auto joint = object->as<Joint>()) {
      effects_.joints.push_back(joint);
    }
  }
  scene.collect(effects_.handlers);
  scene.collect(effects_.extensions);
  formGroups(scene, groups);
  std::vector<ScriptHandler*> scripts;
  scene.collect(scripts);
  scripts_.assign(scripts.begin(), scripts.end());
}

/// A collider belongs to the innermost group: outer groups are set first, inner ones overwrite them. Of several groups
/// in one node the first counts.
void PhysicsServer::formGroups(const Node& scene, std::vector<CollisionGroup*>& groups) {
  const auto depth = [&](const CollisionGroup* group) {
    int n = 0;
    for (const Node* up = group->parent(); up != &scene; up = up->parent()) ++n;
    return n;
  };
  std::stable_sort(groups.begin(), groups.end(), [&](const auto* a, const auto* b) { return depth(a) < depth(b); });
  std::vector<Collider*> members;
  for (const CollisionGroup* group : groups) {
    if (group->parent()->childOf<CollisionGroup>() != group) continue;
    members.clear();
    group->parent()->collect(members);
    for (Collider* collider : members) collider->setGroup(group);
  }
}

bool PhysicsServer::refresh() {
  if (!tree_.changed(*this)) return world_ != nullptr;
  bodies_.clear();
  scripts_.clear();
  rays_.clear();
  effects_.clear();
  world_ = findWorld();
  if (!world_) return false;
  collect(*world_->parent());

  // Outer transforms first: the local matrix of an inner one depends on their new poses.
  for (Placed& p : bodies_)
    for (const Transform* t = p.above; t; t = t->transform()) ++p.depth;
  std::stable_sort(bodies_.begin(), bodies_.end(), [](const Placed& a, const Placed& b) { return a.depth < b.depth; });
  structure_ = 0;
  return true;
}

void PhysicsServer::shiftSurroundings() {
  if (!world_->takeRecentred()) return;
  for (const Placed& p : bodies_) {
    const Vec3 offset = p.body->takeShift();
    if (offset.isZero(0)) continue;
    // The outermost transforms below that of the body.
    std::vector<Transform*> transforms;
    p.body->transform()->collect(transforms, false);
    for (Transform* t : transforms) t->setLocalFromBody(translation(offset.cast<float>()) * t->local());
    // Colliders inside the body's transform colliders.
    for (const auto& sibling : p.body->parent()->children())
      if (auto outer = sibling->as<TransformCollider>())
        for (const auto& child : outer->children())
          if (auto inner = child->as<Collider>()) inner->shift(offset);
  }
}

void PhysicsServer::physics(const Event& event) {
  if (event.step <= 0 || !refresh()) return;
  if (!hasEngines()) return lacksEngines();
  lacking_ = false;
  const InUse stepping(*this, "a step is under way");
  placeTransforms();
  shiftSurroundings();
  solve(event);
  reportFaults();
  for (std::size_t i = 0; i < scripts_.size(); ++i)
    if (scripts_[i] && scripts_[i]->hasEvents()) scripts_[i]->emit(event);
}

namespace {
/// Takes the contacts of a late engine.
struct Sink : engine::IContactSink {
  Sink(engine::Contacts& out, int most) : contacts(out), perPairMost(most) {}
  int perPair() const override { return perPairMost; }
  bool decide(std::span<engine::Contact> points) override {
    if (!physics::pairCounts(points.front().ownerA, points.front().ownerB)) return false;
    physics::decide(points);
    // Whether a handler wants forces is known only after the step.
    for (engine::Contact& c : points) c.feedback = c.solve;
    return true;
  }
  void report(std::span<const engine::Contact> found) override { contacts.assign(found.begin(), found.end()); }
  engine::Contacts& contacts;
  int perPairMost;
};
}  // namespace

void PhysicsServer::restored(const Event&) {
  if (World* const world = currentWorld(); world && world->stepper() && engine_)
    world->stepper()->settle(*engine_, collision_.get());
}

void PhysicsServer::solve(const Event& event) {
  const std::shared_ptr<physics::WorldModel> world = world_->model();
  const std::shared_ptr<physics::Stepper> stepper = world_->stepper();
  engine::IEngine& engine = *engine_;
  effects_.check(engine, world->model());
  engine::ICollision* const collision = collision_.get();
  const InUse solving(engine.leaf(), "a step is under way");
  const InUse detecting(collision ? collision->leaf() : engine.leaf(), "a step is under way");
  const double own = world->model().parameters.timestep, usual = own > 0 ? own : engine.capabilities().usualStep;
  const int steps = usual > 0 ? static_cast<int>(std::clamp(std::round(event.step / usual), 1.0, 1000.0)) : 1;
  stepper->begin(steps);
  const bool late = engine.capabilities().late;
  for (int i = 0; i < steps; ++i) {
    if (late) {
      if (i > 0) stepper->repeatForces();
      solveLate(*world, *stepper, event.step / steps, steps);
      continue;
    }
    // Contacts and their handlers.
    contacts_.clear();
    contactsAt_ = kernel().structureVersion();
    stepper->detect(engine, collision, physics::pairCounts, contactsPerPair_, contacts_);
    physics::runHandlers(contacts_, kernel());

    // One step. Handlers must not see feedback that only measureForces requested.
    measured_.clear();
    if (measureForces_) physics::measure(contacts_, measured_);
    if (i > 0) stepper->repeatForces();
    stepper->step(engine, contacts_, event.step / steps);
    for (const std::size_t k : measured_) contacts_[k].feedback = false;
    physics::runSolved(contacts_, steps);
    for (const std::size_t k : measured_) contacts_[k].feedback = true;
  }
}

void PhysicsServer::solveLate(const physics::WorldModel& world, physics::Stepper& stepper, double dt, int steps) {
  Sink sink(contacts_, contactsPerPair_);
  stepper.step(*engine_, contacts_, dt, &sink);
  contactsAt_ = kernel().structureVersion();
  physics::sortByPair(contacts_, world.model(), order_, sorted_);
  // All forces are there, but handlers see those that they ask for.
  for (engine::Contact& c : contacts_) c.feedback = false;
  physics::runHandlers(contacts_, kernel(), true);
  physics::runSolved(contacts_, steps);
  measured_.clear();
  if (measureForces_) physics::measure(contacts_, measured_);
}

std::span<const engine::Contact> PhysicsServer::contacts() const {
  if (contactsAt_ != kernel().structureVersion()) return {};  // owners may have been removed
  return contacts_;
}

namespace {
// An update of the RayScene costs as much as 5 to 11 queries save, with 50 to 2000 geoms; with 10 it does not matter.
constexpr int kScans = 8;
}  // namespace

/// True if `rays_` can answer a query. The first queries at new poses test every geom; then `rays_` is updated. While
/// one thread updates it, others go on testing every geom: the answers are the same.
bool PhysicsServer::useRayScene(const physics::WorldModel& world) {
  if (rays_.isCurrent(world.model(), world.poses())) return true;
  if (scannedAt_.exchange(world.poses(), std::memory_order_relaxed) != world.poses())
    scans_.store(0, std::memory_order_relaxed);
  if (scans_.fetch_add(1, std::memory_order_relaxed) < kScans) return false;
  const std::unique_lock lock(raysUpdate_, std::try_to_lock);
  if (!lock) return false;
  rays_.update(world.model(), world.state(), world.poses());
  return true;
}

/// A sensor does not sense what moves below `except`: its own robot. What does not move there is ground and walls of
/// the robot's file, or the case that the sensor at `from` is in or on.
bool PhysicsServer::isSensed(const engine::Geom& g, const Vec3& from, const Node* except) const {
  constexpr double kAtSurface = 1e-3;  // m
  if (!except || !isBelow(colliderOf(g.owner).leaf(), *except)) return true;
  if (g.body != engine::kNone) return false;
  const Pose pose = g.shape.shape == engine::Shape::plane ? Pose{} : g.offset;
  return physics::distanceTo(g.shape, pose.rotation.transpose() * (from - pose.position)) > kAtSurface;
}

std::optional<RayHit> PhysicsServer::castRay(const Vec3& from, const Vec3& direction, double length,
                                             const Node* except) {
  const physics::WorldModel& world = expectWorld();
  const double norm = direction.norm();
  if (!from.allFinite() || !(norm > 0) || !std::isfinite(norm) || !(length >= 0))
    throw Error(fmt::format(
        "{}: expected a ray with finite numbers, a direction longer than 0 and a length of 0 or more", path()));
  const Vec3 unit = direction / norm;
  const physics::Accepts accepts = [&](const engine::Geom& g) { return isSensed(g, from, except); };
  const auto hit = useRayScene(world) ? rays_.castRay(from, unit, length, accepts)
                                      : physics::castRay(world.model(), world.state(), from, unit, length, accepts);
  if (!hit) return std::nullopt;
  return RayHit{&colliderOf(world.model().geoms[hit->geom].owner), hit->distance, from + hit->distance * unit,
                hit->normal};
}

Value PhysicsServer::rayFor(const Vec3& from, const Vec3& direction, double length) {
  const std::optional<RayHit> hit = castRay(from, direction, length, nullptr);
  if (!hit) return {};
  return List{hit->distance, hit->collider->leaf().path(), Convert<Vec3>::to(hit->position),
              Convert<Vec3>::to(hit->normal)};
}

Value PhysicsServer::boxOf(const std::string& node) {
  Leaf* const at = find<Leaf>(node);
  if (!at) throw Error(fmt::format("{}.boundingBox: expected the path of a node, found '{}'", path(), node));
  std::vector<ICollider*> colliders;
  if (const auto own = at->as<ICollider>()) colliders.push_back(own);
  if (const auto folder = at->as<Node>()) folder->collect(colliders);
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const ICollider* collider : colliders) {
    Vec3 itsLow, itsHigh;
    collider->bounds(itsLow, itsHigh);
    if (!itsLow.allFinite() || !itsHigh.allFinite()) continue;  // a plane, or one without geometry
    low = low.cwiseMin(itsLow);
    high = high.cwiseMax(itsHigh);
  }
  if (!low.allFinite()) return {};
  return List{Convert<Vec3>::to(low), Convert<Vec3>::to(high)};
}

bool PhysicsServer::isHidden(const Vec3& from, const Vec3& to, const IRigidBody* own, const Node* except) {
  constexpr double kAtSurface = 1e-3;  // m: single-precision positions and rounding
  const physics::WorldModel& world = expectWorld();
  const Vec3 way = to - from;
  const double length = way.norm();
  if (!std::isfinite(length) || length == 0) return false;
  const Vec3 unit = way / length;
  const auto hides = [&](const engine::Geom& g) {
    ICollider& collider = colliderOf(g.owner);
    if ((own && collider.body() == own) || (except && isBelow(collider.leaf(), *except))) return false;
    const auto index = static_cast<engine::Index>(&g - world.model().geoms.data());
    const Pose pose = physics::poseOf(world.model(), world.state(), index);
    return physics::distanceTo(g.shape, pose.rotation.transpose() * (to - pose.position)) > kAtSurface;
  };
  const physics::Accepts accepts = std::cref(hides);  // a copy would allocate
  if (useRayScene(world)) return rays_.meets(from, unit, length, accepts);
  return physics::castRay(world.model(), world.state(), from, unit, length, accepts).has_value();
}

void PhysicsServer::prepareRays() {
  if (!refresh()) return;
  const physics::WorldModel& world = *world_->model();
  rays_.update(world.model(), world.state(), world.poses());
}

void PhysicsServer::overlaps(const Vec3& center, double radius, std::vector<ICollider*>& out) {
  const physics::WorldModel& world = expectWorld();
  std::vector<engine::Index> geoms;
  if (useRayScene(world))
    rays_.findOverlaps(center, radius, geoms);
  else
    physics::findOverlaps(world.model(), world.state(), center, radius, geoms);
  for (const engine::Index i : geoms) out.push_back(&colliderOf(world.model().geoms[i].owner));
}

void PhysicsServer::listen(const SoundCone& cone, int rings, const Node* except, std::vector<Echo>& out) {
  const physics::WorldModel& world = expectWorld();
  if (!cone.apex.allFinite() || !cone.axis.allFinite() || !(cone.axis.norm() > 0) || !(cone.range >= 0)) return;
  if (!rays_.isCurrent(world.model(), world.poses())) {
    const std::lock_guard lock(raysUpdate_);
    rays_.update(world.model(), world.state(), world.poses());
  }
  const auto counts = [&](const engine::Geom& g) { return isSensed(g, cone.apex, except); };
  const physics::Accepts accepts = std::cref(counts);
  thread_local std::vector<physics::RayScene::GeomEcho> heard;
  heard.clear();
  const double angle = std::clamp(cone.halfAngle, 0.0, kPi);
  rays_.listen({cone.apex, cone.axis.normalized(), std::cos(angle), std::sin(angle), cone.range}, rings, accepts,
               heard);
  for (const auto& echo : heard) out.push_back({&colliderOf(world.model().geoms[echo.geom].owner), echo.distance});
}

void PhysicsServer::reportFaults() {
  // One line for all of them: a robot has many.
  const RigidBody* first = nullptr;
  std::size_t others = 0;
  for (const physics::BodyHandle handle : world_->stepper()->repaired())
    for (const Placed& p : bodies_)
      if (p.body->handle() == handle && p.body->countFault()) (first ? void(++others) : void(first = p.body));
  if (!first) return;
  kernel().log().error(
      "{}{}: its position or speed was no number after the step; it was put back to its last good place, at rest. Look "
      "for extreme forces, masses or joint parameters.",
      first->path(), others > 0 ? fmt::format(" (and {} more)", others) : "");
}

namespace {
constexpr std::size_t kAhead = 6;        // prefetch distance [bodies]
constexpr std::size_t kTransform = 384;  // bytes of a transform that place() reads and writes
}  // namespace

void PhysicsServer::place(const Event&) {
  if (!refresh()) return;
  const physics::WorldModel& world = *world_->model();
  if (std::exchange(structure_, world.model().structure) != structure_)
    for (Placed& p : bodies_) p.index = world.index(p.body->handle());
  const std::vector<engine::DynamicState>& states = world.state().bodies;

  // The bodies of a robot share the transform above: its inverse is computed once.
  const Transform* inverted = nullptr;
  Matrix inverse;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (i + kAhead < bodies_.size() && bodies_[i + kAhead].moving) prefetch(bodies_[i + kAhead].transform, kTransform);
    Placed& p = bodies_[i];
    const engine::DynamicState& state = states[p.index];

    // Skip bodies that sleep and whose transform is up to date. One that was awake at the last placing and still is
    // needs no check.
    if (!state.awake || !p.moving) {
      p.moving = state.awake;
      if (!p.body->takeUnplaced()) continue;
    }

    const Matrix pose = toMatrix({state.position, state.rotation});
    if (p.above && p.above != inverted) {
      inverse = rigidInverse(p.above->worldNow());
      inverted = p.above;
    }
    p.transform->setLocalFromBody(p.above ? Matrix(inverse * pose) : pose);
  }
  placeTransforms();
}

void PhysicsServer::placeTransforms() {
  if (scenes_) scenes_->placeScene(*world_->parent());
}

void PhysicsServer::lacksEngines() {
  if (std::exchange(lacking_, true)) return;
  try {
    expectEngines();
  } catch (const Error& e) {
    kernel().log().error("{}. Nothing moves until then.", e.what());
  }
}

}  // namespace spark
