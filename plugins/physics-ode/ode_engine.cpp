#include "ode_engine.h"

#include <algorithm>

#include "spark/plugin.h"
#include "spark/prefetch.h"

namespace spark {

using namespace ode;
using engine::Body;
using engine::Space;
using engine::World;

OdeEngine::~OdeEngine() {
  while (!worlds_.empty()) destroyWorld(World{reinterpret_cast<std::uintptr_t>(worlds_.back().get())});
}

World OdeEngine::createWorld() {
  const Listening listening(said_);
  auto w = std::make_unique<WorldData>();
  w->id = dWorldCreate();
  w->threads = std::make_unique<IslandThreads>(kernel().jobs());
  w->threads->serve(w->id);
  w->root = dHashSpaceCreate(nullptr);
  dSpaceSetCleanup(w->root, 0);
  w->contactJoints = dJointGroupCreate(0);
  w->exactReplay = exactReplay_;
  const World handle{reinterpret_cast<std::uintptr_t>(w.get())};
  worlds_.push_back(std::move(w));
  setWorldParameters(handle, {});
  return handle;
}

void OdeEngine::destroyWorld(World world) {
  const Listening listening(said_);
  WorldData& w = *data(world);
  if (auto* solver = childOf<engine::ISolver>()) solver->forget(world);
  dJointGroupDestroy(w.contactJoints);
  while (!w.joints.empty()) destroyJoint(engine::Joint{reinterpret_cast<std::uintptr_t>(w.joints.back().get())});
  while (!w.geoms.empty()) destroyGeom(engine::Geom{reinterpret_cast<std::uintptr_t>(w.geoms.back().get())});
  while (!w.bodies.empty()) destroyBody(Body{reinterpret_cast<std::uintptr_t>(w.bodies.back().get())});
  // Inner spaces are younger than those around them.
  while (!w.spaces.empty()) destroySpace(Space{reinterpret_cast<std::uintptr_t>(w.spaces.back().get())});
  dSpaceDestroy(w.root);
  dWorldSetStepThreadingImplementation(w.id, nullptr, nullptr);
  dWorldDestroy(w.id);
  forget(worlds_, &w);
}

void OdeEngine::setWorldParameters(World world, const engine::WorldParameters& p) {
  WorldData& w = *data(world);
  if (!sane(p.gravity)) throw Error("expected a finite gravity for the world");
  const Vec3 gravity = crossing(w, p.gravity);
  dWorldSetGravity(w.id, gravity.x(), gravity.y(), gravity.z());
  dWorldSetERP(w.id, p.erp);
  dWorldSetCFM(w.id, crossing(w, p.cfm));
  dWorldSetContactSurfaceLayer(w.id, crossing(w, p.contactSurfaceLayer));
  dWorldSetAutoDisableFlag(w.id, 0);
  w.parameters = {gravity, p.erp, crossing(w, p.cfm), p.autoDisable, crossing(w, p.contactSurfaceLayer)};
  for (const auto& j : w.joints) frames::worldChanged(*j);
}

Space OdeEngine::createSpace(World world, Space parent) {
  WorldData& w = *data(world);
  auto s = std::make_unique<SpaceData>();
  s->world = &w;
  s->top = w.exactReplay && parent == Space::none;
  const dSpaceID around = s->top ? nullptr : parent == Space::none ? w.root : data(parent)->id;
  // ODE's sweep-and-prune spaces do not know how far they reach: inside another space they would meet everything.
  const bool sweeps = !w.exactReplay && parent == Space::none;
  s->id = sweeps ? dSweepAndPruneSpaceCreate(around, dSAP_AXES_XYZ) : dHashSpaceCreate(around);
  dSpaceSetCleanup(s->id, 0);
  dGeomSetData(reinterpret_cast<dGeomID>(s->id), s.get());
  const Space handle{reinterpret_cast<std::uintptr_t>(s.get())};
  w.spaces.push_back(std::move(s));
  return handle;
}

void OdeEngine::destroySpace(Space space) {
  SpaceData* s = data(space);
  dSpaceDestroy(s->id);
  forget(s->world->spaces, s);
}

void OdeEngine::setInnerCollision(Space space, bool on) { data(space)->inner = on; }

namespace {

void setSurface(dSurfaceParameters& to, const engine::Surface& s, const WorldData& w) {
  to.mode = (s.bounceOn ? dContactBounce : 0) | (s.softErpOn ? dContactSoftERP : 0) |
            (s.softCfmOn ? dContactSoftCFM : 0) | (s.slipOn ? dContactSlip1 | dContactSlip2 : 0) |
            (s.pyramid ? dContactApprox1 : 0);
  to.mu = crossing(w, s.mu);
  to.bounce = crossing(w, s.bounce);
  to.bounce_vel = crossing(w, s.bounceVelocity);
  to.soft_erp = crossing(w, s.softErp);
  to.soft_cfm = crossing(w, s.softCfm);
  to.slip1 = crossing(w, s.slip1);
  to.slip2 = crossing(w, s.slip2);
}

/// Notes that a body has a contact; `rows` with the static world.
void touch(WorldData& w, BodyData& b, int rows) {
  if (b.touchedAt != w.steps) b.staticRows = 0;
  b.touchedAt = w.steps;
  b.staticRows += rows;
  w.mostStaticRows = std::max(w.mostStaticRows, b.staticRows);
}

}  // namespace

void OdeEngine::pairUp(WorldData& w, const engine::Contacts& contacts) {
  w.contactPairs.clear();
  w.unitingRows = w.staticRows = w.mostStaticRows = 0;
  for (const engine::Contact& c : contacts) {
    engine::SolverPair& pair = w.contactPairs.emplace_back();
    if (!c.solve) continue;
    BodyData* a = data(c.geomA)->body;
    BodyData* b = data(c.geomB)->body;
    pair.reversed = !a;
    pair.a = a ? a : b;
    pair.b = a ? b : nullptr;
    const bool both = a && b;
    (both ? w.unitingRows : w.staticRows) += kContactRows;
    if (a) touch(w, *a, both ? 0 : kContactRows);
    if (b) touch(w, *b, both ? 0 : kContactRows);
  }
}

namespace {

bool isDeferred(const engine::SolverPair& pair) { return pair.a && (pair.a->deferred || (pair.b && pair.b->deferred)); }

}  // namespace

void OdeEngine::addContactJoints(WorldData& w, const engine::Contacts& contacts) {
  w.feedback.clear();
  // ODE keeps pointers into it: it must not grow below.
  if (w.feedback.capacity() < contacts.size()) w.feedback.reserve(contacts.size() * 2);
  dContact contact{};
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const engine::SolverPair& pair = w.contactPairs[i];
    if (!isDeferred(pair)) continue;
    const engine::Contact& c = contacts[i];
    setSurface(contact.surface, c.surface, w);
    for (int k = 0; k < 3; ++k) contact.geom.pos[k] = c.position[k], contact.geom.normal[k] = c.normal[k];
    contact.geom.depth = c.depth;
    contact.geom.g1 = data(c.geomA)->id;
    contact.geom.g2 = data(c.geomB)->id;
    const dJointID joint = dJointCreateContact(w.id, w.contactJoints, &contact);
    const dBodyID a = data(pair.a)->id;
    if (pair.reversed)
      dJointAttach(joint, nullptr, a);
    else
      dJointAttach(joint, a, pair.b ? data(pair.b)->id : nullptr);
    if (c.feedback) {
      w.feedback.push_back({});
      dJointSetFeedback(joint, &w.feedback.back());
    }
  }
}

void OdeEngine::readFeedback(WorldData& w, engine::Contacts& contacts) {
  if (w.feedback.empty()) return;
  std::size_t next = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    engine::Contact& c = contacts[i];
    const engine::SolverPair& pair = w.contactPairs[i];
    if (!c.feedback || !isDeferred(pair)) continue;
    const Vec3 onFirst = toVec(w.feedback[next++].f1);
    // A joint whose first body is the world is turned round by ODE.
    c.forceOnA = pair.reversed ? Vec3(-onFirst) : onFirst;
  }
}

void OdeEngine::stepByOde(WorldData& w, engine::Contacts& contacts, double dt) {
  addContactJoints(w, contacts);
  // Islands do not touch each other: nothing wakes what had its step.
  for (BodyData* b : w.solved) dBodyDisable(b->id);
  solve(w, dt);
  for (BodyData* b : w.solved) dBodyEnable(b->id);
  readFeedback(w, contacts);
  dJointGroupEmpty(w.contactJoints);
}

void OdeEngine::sleep(WorldData& w, double dt) {
  for (const auto& body : w.bodies) {
    BodyData& b = *body;
    // Nothing sleeps in mid-air.
    if ((b.joints == 0 && b.touchedAt != w.steps) || !b.awake) continue;
    if (dCalcVectorDot3(b.linearVelocity, b.linearVelocity) > kIdleSpeedSquared ||
        dCalcVectorDot3(b.angularVelocity, b.angularVelocity) > kIdleSpeedSquared) {
      b.stepsLeft = kIdleSteps;
      b.timeLeft = 0;
      continue;
    }
    --b.stepsLeft;
    b.timeLeft -= dt;
    if (b.stepsLeft > 0 || b.timeLeft > 0) continue;
    setAwake(b, false);
    dBodySetLinearVel(b.id, 0, 0, 0);
    dBodySetAngularVel(b.id, 0, 0, 0);
  }
}

/// ODE's solver leaves nothing of bodies in the caches: the next ones' memory is under way meanwhile.
void OdeEngine::lookAfterStep(WorldData& w, bool byOde) {
  constexpr std::size_t kFar = 8, kNear = 4;
  constexpr std::size_t kLooked = 224;  // bytes of ODE's from a body's position to its angular velocity
  const std::size_t n = w.bodies.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (i + kFar < n) prefetch(w.bodies[i + kFar].get(), sizeof(BodyData));
    if (i + kNear < n) prefetch(w.bodies[i + kNear]->position, kLooked);
    BodyData& b = *w.bodies[i];
    // Nobody falls asleep in ODE's step, but it wakes what hangs on something awake.
    if (!b.awake && byOde) b.awake = dBodyIsEnabled(b.id) != 0;
    if (!b.awake) continue;
    if (sane(b.position, 3) && sane(b.quaternion, 4) && sane(b.linearVelocity, 3) && sane(b.angularVelocity, 3)) {
      std::copy(b.position, b.position + 3, b.good.position);
      std::copy(b.quaternion, b.quaternion + 4, b.good.quaternion);
      continue;
    }
    dBodySetPosition(b.id, b.good.position[0], b.good.position[1], b.good.position[2]);
    dBodySetQuaternion(b.id, b.good.quaternion);
    dBodySetLinearVel(b.id, 0, 0, 0);
    dBodySetAngularVel(b.id, 0, 0, 0);
    w.repaired.push_back(Body{reinterpret_cast<std::uintptr_t>(&b)});
  }
}

void OdeEngine::step(World world, engine::Contacts& contacts, double dt) {
  WorldData& w = *data(world);
  const Listening listening(said_);
  ++w.steps;
  w.repaired.clear();
  if (std::none_of(w.bodies.begin(), w.bodies.end(), [](const auto& b) { return b->awake; })) return;
  pairUp(w, contacts);
  if (w.parameters.autoDisable) sleep(w, dt);
  engine::ISolver* const inPlace = solver();
  const bool byOde = !inPlace || stepBySolver(w, *inPlace, contacts, crossing(w, dt)) > 0;
  if (byOde) stepByOde(w, contacts, crossing(w, dt));
  lookAfterStep(w, byOde);
  ++w.rotations;
  if (byOde) tellAngles(w);
  if (!said_.empty()) report();
}

std::span<const Body> OdeEngine::repaired(World world) const { return data(world)->repaired; }

void OdeEngine::report() {
  ++messages_;
  if ((messages_ & (messages_ - 1)) == 0)
    kernel().log().warning("{}: ODE says: {} (message {} of this kind of trouble)", path(), said_, messages_);
  said_.clear();
}

}  // namespace spark

SPARK_PLUGIN("physics-ode", "1.0", "The Open Dynamics Engine as engine of the physics server.", spark::OdeEngine)
