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
  while (!worlds_.empty()) destroyWorld(handle(*worlds_.back()));
}

World OdeEngine::createWorld() {
  const MessageCapture capture(odeMessage_);
  auto w = std::make_unique<WorldData>();
  w->id = dWorldCreate();
  w->threads = std::make_unique<IslandThreads>(kernel().jobs());
  w->threads->attachTo(w->id);
  w->root = dHashSpaceCreate(nullptr);
  dSpaceSetCleanup(w->root, 0);
  w->contactJoints = dJointGroupCreate(0);
  w->exactReplay = exactReplay_;
  const World created = handle(*w);
  worlds_.push_back(std::move(w));
  setWorldParameters(created, {});
  return created;
}

void OdeEngine::destroyWorld(World world) {
  const MessageCapture capture(odeMessage_);
  WorldData& w = *data(world);
  if (auto* solver = childOf<engine::ISolver>()) solver->forget(world);

  // Joints before bodies, geoms before spaces.
  dJointGroupDestroy(w.contactJoints);
  while (!w.joints.empty()) destroyJoint(handle(*w.joints.back()));
  while (!w.geoms.empty()) destroyGeom(handle(*w.geoms.back()));
  while (!w.bodies.empty()) destroyBody(handle(*w.bodies.back()));
  // From the last: inner spaces were created after the spaces around them.
  while (!w.spaces.empty()) destroySpace(handle(*w.spaces.back()));
  dSpaceDestroy(w.root);
  dWorldSetStepThreadingImplementation(w.id, nullptr, nullptr);
  dWorldDestroy(w.id);
  removeFrom(worlds_, &w);
}

void OdeEngine::setWorldParameters(World world, const engine::WorldParameters& p) {
  WorldData& w = *data(world);
  if (!inRange(p.gravity)) throw Error("expected a finite gravity for the world");
  const Vec3 gravity = rounded(w, p.gravity);
  dWorldSetGravity(w.id, gravity.x(), gravity.y(), gravity.z());
  dWorldSetERP(w.id, p.erp);
  dWorldSetCFM(w.id, rounded(w, p.cfm));
  dWorldSetContactSurfaceLayer(w.id, rounded(w, p.contactSurfaceLayer));
  dWorldSetAutoDisableFlag(w.id, 0);  // see autoDisable()
  w.parameters = {gravity, p.erp, rounded(w, p.cfm), p.autoDisable, rounded(w, p.contactSurfaceLayer)};
  for (const auto& j : w.joints) mirror::worldParametersSet(*j);
}

Space OdeEngine::createSpace(World world, Space parent) {
  WorldData& w = *data(world);
  auto s = std::make_unique<SpaceData>();
  s->world = &w;
  s->top = w.exactReplay && parent == Space::none;
  const dSpaceID around = s->top ? nullptr : parent == Space::none ? w.root : data(parent)->id;
  // ODE's sweep-and-prune spaces do not compute their own bounds: inside another space they would overlap everything.
  const bool sweepAndPrune = !w.exactReplay && parent == Space::none;
  s->id = sweepAndPrune ? dSweepAndPruneSpaceCreate(around, dSAP_AXES_XYZ) : dHashSpaceCreate(around);
  dSpaceSetCleanup(s->id, 0);
  dGeomSetData(reinterpret_cast<dGeomID>(s->id), s.get());
  const Space created = handle(*s);
  w.spaces.push_back(std::move(s));
  return created;
}

void OdeEngine::destroySpace(Space space) {
  SpaceData* s = data(space);
  dSpaceDestroy(s->id);
  removeFrom(s->world->spaces, s);
}

void OdeEngine::setInnerCollision(Space space, bool on) { data(space)->inner = on; }

namespace {

void setSurface(dSurfaceParameters& to, const engine::Surface& s, const WorldData& w) {
  to.mode = (s.bounceOn ? dContactBounce : 0) | (s.softErpOn ? dContactSoftERP : 0) |
            (s.softCfmOn ? dContactSoftCFM : 0) | (s.slipOn ? dContactSlip1 | dContactSlip2 : 0) |
            (s.pyramid ? dContactApprox1 : 0);
  to.mu = rounded(w, s.mu);
  to.bounce = rounded(w, s.bounce);
  to.bounce_vel = rounded(w, s.bounceVelocity);
  to.soft_erp = rounded(w, s.softErp);
  to.soft_cfm = rounded(w, s.softCfm);
  to.slip1 = rounded(w, s.slip1);
  to.slip2 = rounded(w, s.slip2);
}

/// Records a contact of a body in this step; `rows` are those of a contact with a static geom, else 0.
void recordContact(WorldData& w, BodyData& b, int rows) {
  if (b.lastContactStep != w.steps) b.staticRows = 0;
  b.lastContactStep = w.steps;
  b.staticRows += rows;
  w.maxStaticRows = std::max(w.maxStaticRows, b.staticRows);
}

}  // namespace

void OdeEngine::findContactPairs(WorldData& w, const engine::Contacts& contacts) {
  w.contactPairs.clear();
  w.couplingRows = w.staticRows = w.maxStaticRows = 0;
  for (const engine::Contact& c : contacts) {
    engine::SolverPair& pair = w.contactPairs.emplace_back();
    if (!c.solve) continue;
    BodyData* a = data(c.geomA)->body;
    BodyData* b = data(c.geomB)->body;
    pair.reversed = !a;
    pair.a = a ? a : b;
    pair.b = a ? b : nullptr;
    const bool both = a && b;
    (both ? w.couplingRows : w.staticRows) += kContactRows;
    if (a) recordContact(w, *a, both ? 0 : kContactRows);
    if (b) recordContact(w, *b, both ? 0 : kContactRows);
  }
}

namespace {

bool isDeferred(const engine::SolverPair& pair) { return pair.a && (pair.a->deferred || (pair.b && pair.b->deferred)); }

}  // namespace

void OdeEngine::addContactJoints(WorldData& w, const engine::Contacts& contacts) {
  w.feedback.clear();
  // ODE keeps pointers to the elements: the vector must not reallocate below.
  if (w.feedback.capacity() < contacts.size()) w.feedback.reserve(contacts.size() * 2);
  dContact contact{};
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const engine::SolverPair& pair = w.contactPairs[i];
    if (!isDeferred(pair)) continue;
    const engine::Contact& c = contacts[i];

    // The contact in ODE's form.
    setSurface(contact.surface, c.surface, w);
    for (int k = 0; k < 3; ++k) contact.geom.pos[k] = c.position[k], contact.geom.normal[k] = c.normal[k];
    contact.geom.depth = c.depth;
    contact.geom.g1 = data(c.geomA)->id;
    contact.geom.g2 = data(c.geomB)->id;

    // Its joint, with the bodies in the order of the geoms.
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
    // ODE reverses a joint whose first body is the world.
    c.forceOnA = pair.reversed ? Vec3(-onFirst) : onFirst;
  }
}

void OdeEngine::stepByOde(WorldData& w, engine::Contacts& contacts, double dt) {
  addContactJoints(w, contacts);
  // Disabled bodies are skipped. Islands do not touch, so ODE does not wake the bodies that the solver has stepped.
  for (BodyData* b : w.solved) dBodyDisable(b->id);
  solve(w, dt);
  for (BodyData* b : w.solved) dBodyEnable(b->id);
  readFeedback(w, contacts);
  dJointGroupEmpty(w.contactJoints);
}

void OdeEngine::autoDisable(WorldData& w, double dt) {
  for (const auto& body : w.bodies) {
    BodyData& b = *body;
    // A body without joints and contacts is in free flight: it does not fall asleep.
    if ((b.joints == 0 && b.lastContactStep != w.steps) || !b.awake) continue;
    if (dCalcVectorDot3(b.linearVelocity, b.linearVelocity) > kIdleSpeedSquared ||
        dCalcVectorDot3(b.angularVelocity, b.angularVelocity) > kIdleSpeedSquared) {
      b.idleStepsLeft = kIdleSteps;
      b.idleTimeLeft = 0;
      continue;
    }
    // Idle: asleep when both counters have run out.
    --b.idleStepsLeft;
    b.idleTimeLeft -= dt;
    if (b.idleStepsLeft > 0 || b.idleTimeLeft > 0) continue;
    setAwake(b, false);
    dBodySetLinearVel(b.id, 0, 0, 0);
    dBodySetAngularVel(b.id, 0, 0, 0);
  }
}

void OdeEngine::checkBodies(WorldData& w, bool byOde) {
  // ODE's solver has evicted the bodies from the caches: prefetch them, first the data here, then ODE's.
  constexpr std::size_t kFar = 8, kNear = 4;  // prefetch distances [bodies]
  constexpr std::size_t kOdeState = 224;      // bytes in an ODE body from its position to its angular velocity
  const std::size_t n = w.bodies.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (i + kFar < n) prefetch(w.bodies[i + kFar].get(), sizeof(BodyData));
    if (i + kNear < n) prefetch(w.bodies[i + kNear]->position, kOdeState);
    BodyData& b = *w.bodies[i];

    // ODE's step puts no body to sleep, but it wakes bodies that are connected to an awake one.
    if (!b.awake && byOde) b.awake = dBodyIsEnabled(b.id) != 0;
    if (!b.awake) continue;
    if (inRange(b.position, 3) && inRange(b.quaternion, 4) && inRange(b.linearVelocity, 3) &&
        inRange(b.angularVelocity, 3)) {
      std::copy(b.position, b.position + 3, b.lastValid.position);
      std::copy(b.quaternion, b.quaternion + 4, b.lastValid.quaternion);
      continue;
    }

    // The state is invalid: reset the body.
    dBodySetPosition(b.id, b.lastValid.position[0], b.lastValid.position[1], b.lastValid.position[2]);
    dBodySetQuaternion(b.id, b.lastValid.quaternion);
    dBodySetLinearVel(b.id, 0, 0, 0);
    dBodySetAngularVel(b.id, 0, 0, 0);
    w.repaired.push_back(handle(b));
  }
}

void OdeEngine::step(World world, engine::Contacts& contacts, double dt) {
  WorldData& w = *data(world);
  const MessageCapture capture(odeMessage_);
  ++w.steps;
  w.repaired.clear();
  if (std::none_of(w.bodies.begin(), w.bodies.end(), [](const auto& b) { return b->awake; })) return;
  findContactPairs(w, contacts);
  if (w.parameters.autoDisable) autoDisable(w, dt);

  // The solver steps the islands that it can handle, ODE the deferred ones; without a solver all are deferred.
  engine::ISolver* const replacement = solver();
  const bool byOde = !replacement || stepBySolver(w, *replacement, contacts, rounded(w, dt)) > 0;
  if (byOde) stepByOde(w, contacts, rounded(w, dt));

  checkBodies(w, byOde);
  ++w.angleVersion;
  if (byOde) cacheAngles(w);
  if (!odeMessage_.empty()) report();
}

std::span<const Body> OdeEngine::repaired(World world) const { return data(world)->repaired; }

void OdeEngine::report() {
  ++messages_;
  if ((messages_ & (messages_ - 1)) == 0)
    kernel().log().warning("{}: ODE reports: {} (message {})", path(), odeMessage_, messages_);
  odeMessage_.clear();
}

}  // namespace spark

SPARK_PLUGIN("physics-ode", "1.0", "The Open Dynamics Engine as engine of the physics server.", spark::OdeEngine)
