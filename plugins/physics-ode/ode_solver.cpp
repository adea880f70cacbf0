#include <algorithm>
#include <limits>

#include "api/single_precision.h"
#include "ode_engine.h"
#include "spark/prefetch.h"

namespace spark::ode {

using engine::Contact;
using engine::DynamicState;
using engine::Index;
using engine::kNone;
using engine::Model;

WorldData::WorldData(bool replay, Jobs& jobs)
    : id(dWorldCreate()),
      threads(std::make_unique<IslandThreads>(jobs)),
      contactJoints(dJointGroupCreate(0)),
      exactReplay(replay) {
  threads->attachTo(id);
  dWorldSetData(id, this);
  dWorldSetAutoDisableFlag(id, 0);
}

WorldData::~WorldData() {
  dJointGroupDestroy(contactJoints);
  clearLaws(*this);
  for (const auto& j : joints) dJointDestroy(j->joint);
  for (const BodyData& b : bodies) dBodyDestroy(b.body);
  dWorldSetStepThreadingImplementation(id, nullptr, nullptr);
  dWorldDestroy(id);
}

OdeSolver::OdeSolver(OdeEngine& engine, bool exactReplay)
    : engine_(engine), world_(exactReplay, engine.kernel().jobs()) {}

// ---- compile ----

namespace {

/// Copies the state of a body that ODE has just moved, while it is in the caches.
void readState(dBodyID body) {
  WorldData& w = *static_cast<WorldData*>(dWorldGetData(dBodyGetWorld(body)));
  const auto i = static_cast<Index>(reinterpret_cast<std::uintptr_t>(dBodyGetData(body)));
  BodyData& b = w.bodies[i];
  DynamicState& s = w.state->bodies[i];
  std::copy_n(b.position, 3, s.position.data());
  std::copy_n(b.quaternion, 4, s.quaternion.data());
  s.rotation = toMat(b.rotation);
  std::copy_n(b.linearVelocity, 3, s.linearVelocity.data());
  std::copy_n(b.angularVelocity, 3, s.angularVelocity.data());
  s.force.setZero();
  s.torque.setZero();
  s.awake = true;
  b.version = ++s.version;
  b.movedStep = w.steps;
  w.enabled[i] = 1;
  if (w.listOrder) w.order.push_back(i);
}

BodyData createBody(WorldData& w, std::uint64_t id) {
  BodyData b;
  b.id = id;
  b.body = dBodyCreate(w.id);
  dBodySetMovedCallback(b.body, readState);
  // ODE's getters return pointers into the body, which stay valid as long as it lives.
  b.position = const_cast<dReal*>(dBodyGetPosition(b.body));
  b.quaternion = const_cast<dReal*>(dBodyGetQuaternion(b.body));
  b.rotation = const_cast<dReal*>(dBodyGetRotation(b.body));
  b.linearVelocity = const_cast<dReal*>(dBodyGetLinearVel(b.body));
  b.angularVelocity = const_cast<dReal*>(dBodyGetAngularVel(b.body));
  b.force = const_cast<dReal*>(dBodyGetForce(b.body));
  b.torque = const_cast<dReal*>(dBodyGetTorque(b.body));
  return b;
}

void setMass(BodyData& b, const engine::Body& from) {
  if (b.gravity != from.gravity) dBodySetGravityMode(b.body, b.gravity = from.gravity);
  if (b.mass == from.mass && b.inertia == from.inertia) return;
  dMass m;
  dMassSetZero(&m);
  m.mass = b.mass = from.mass;
  b.inertia = from.inertia;
  toOde(from.inertia, m.I);
  dBodySetMass(b.body, &m);
}

/// Brings ODE's bodies up to date with the model.
void compileBodies(WorldData& w, const Model& model) {
  std::erase_if(w.bodies, [&](const BodyData& b) {
    if (engine::indexOf(model.bodies, b.id) != kNone) return false;
    dBodyDestroy(b.body);
    return true;
  });
  while (w.bodies.size() < model.bodies.size()) w.bodies.push_back(createBody(w, model.bodies[w.bodies.size()].id));
  for (std::size_t i = 0; i < w.bodies.size(); ++i) {
    setMass(w.bodies[i], model.bodies[i]);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the index, for visitNeighbours()
    dBodySetData(w.bodies[i].body, reinterpret_cast<void*>(i));
  }
  // ODE's own flags are found out anew.
  w.needed.assign(w.bodies.size(), 0);
  w.enabled.resize(w.bodies.size());
  for (std::size_t i = 0; i < w.bodies.size(); ++i) w.enabled[i] = dBodyIsEnabled(w.bodies[i].body) != 0;
  // A step must not allocate.
  for (std::vector<Index>* list : {&w.excluded, &w.visitStack, &w.order}) list->reserve(w.bodies.size());
}

}  // namespace

void OdeSolver::compile(const Model& model, const engine::State& state) {
  const MessageCapture capture(engine_.messages_.last);
  WorldData& w = world_;
  const engine::WorldParameters& p = model.parameters;
  dWorldSetGravity(w.id, p.gravity.x(), p.gravity.y(), p.gravity.z());
  dWorldSetERP(w.id, p.erp);
  dWorldSetCFM(w.id, p.cfm);
  dWorldSetContactSurfaceLayer(w.id, p.contactSurfaceLayer);

  // Removed joints before the bodies that they connect.
  if (std::exchange(w.structure, model.structure) != model.structure) clearLaws(w);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < w.joints.size(); ++i) {
    if (engine::indexOf(model.joints, w.joints[i]->id) == kNone) {
      dJointDestroy(w.joints[i]->joint);
      continue;
    }
    w.motors[kept] = w.motors[i];
    std::swap(w.joints[kept++], w.joints[i]);
  }
  w.joints.resize(kept);
  w.motors.resize(kept);
  compileBodies(w, model);
  try {
    compileJoints(w, model, state);
  } catch (const Failure& failure) {
    engine_.messages_.fail(engine_, failure.what(), "A joint has no effect, or not that of its frames");
  }
  w.jointRowsCounted = false;
  // Joints were set with the bodies at other places: their states have to be passed again.
  for (BodyData& b : w.bodies) b.version = 0;
  engine_.messages_.report(engine_);
}

// ---- step ----

namespace {

/// Finds the bodies whose state ODE needs: those that are awake, and those that joints and contacts connect to one.
/// Returns the number of awake ones.
std::size_t findNeeded(WorldData& w, const engine::Step& step) {
  std::size_t awake = 0;
  for (Index i = 0; i < w.bodies.size(); ++i) {
    w.needed[i] = step.steps(i) && step.state.bodies[i].awake;
    awake += w.needed[i];
  }
  if (awake == 0 || awake == w.bodies.size()) return awake;
  const auto join = [&](Index a, Index b) {
    const bool differ = w.needed[a] != w.needed[b];
    if (differ) w.needed[a] = w.needed[b] = 1;
    return differ;
  };
  for (bool more = true; more;) {
    more = false;
    for (const auto& [a, b] : w.links) more |= join(a, b);
    for (const Contact& c : step.contacts)
      if (c.solve && c.bodyA != kNone && c.bodyB != kNone) more |= join(c.bodyA, c.bodyB);
  }
  return awake;
}

/// Copies the state of the bodies that ODE needs to ODE, where it is another, without change of a bit, and enables
/// those that are awake.
void writeState(WorldData& w, const engine::Step& step) {
  constexpr std::size_t kAhead = 4;       // prefetch distance [bodies]
  constexpr std::size_t kOdeForces = 64;  // bytes in an ODE body from its force to its torque
  const std::size_t n = w.bodies.size();
  for (Index i = 0; i < n; ++i) {
    if (i + kAhead < n && w.needed[i + kAhead]) prefetch(w.bodies[i + kAhead].force, kOdeForces);
    BodyData& b = w.bodies[i];
    const DynamicState& s = step.state.bodies[i];
    const bool active = w.needed[i] && s.awake;
    if (active != (w.enabled[i] != 0)) (w.enabled[i] = active) ? dBodyEnable(b.body) : dBodyDisable(b.body);
    if (!w.needed[i]) continue;
    std::copy_n(s.force.data(), 3, b.force);
    std::copy_n(s.torque.data(), 3, b.torque);
    if (std::exchange(b.version, s.version) == s.version) continue;
    std::copy_n(s.position.data(), 3, b.position);
    std::copy_n(s.quaternion.data(), 4, b.quaternion);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) b.rotation[4 * row + column] = s.rotation(row, column);
    std::copy_n(s.linearVelocity.data(), 3, b.linearVelocity);
    std::copy_n(s.angularVelocity.data(), 3, b.angularVelocity);
  }
}

void setSurface(dSurfaceParameters& to, const engine::Surface& s, bool exactReplay) {
  const auto rounded = [exactReplay](double v) { return exactReplay ? roundToFloat(v) : v; };
  to.mode = (s.bounceOn ? dContactBounce : 0) | (s.softErpOn ? dContactSoftERP : 0) |
            (s.softCfmOn ? dContactSoftCFM : 0) | (s.slipOn ? dContactSlip1 | dContactSlip2 : 0) |
            (s.pyramid ? dContactApprox1 : 0);
  to.mu = rounded(s.mu);
  to.bounce = rounded(s.bounce);
  to.bounce_vel = rounded(s.bounceVelocity);
  to.soft_erp = rounded(s.softErp);
  to.soft_cfm = rounded(s.softCfm);
  to.slip1 = rounded(s.slip1);
  to.slip2 = rounded(s.slip2);
}

/// True when the contact is a constraint of this step.
bool counts(const Contact& c, const engine::Step& step) {
  return c.solve && step.steps(c.bodyA != kNone ? c.bodyA : c.bodyB);
}

/// Records a contact of a body in this step; `rows` are those of a contact with a static geom, else 0.
void recordContact(WorldData& w, Index body, int rows) {
  if (body == kNone) return;
  BodyData& b = w.bodies[body];
  if (b.lastContactStep != w.steps) b.staticRows = 0;
  b.lastContactStep = w.steps;
  b.staticRows += rows;
  w.maxStaticRows = std::max(w.maxStaticRows, b.staticRows);
}

void addContactJoints(WorldData& w, const engine::Step& step) {
  w.couplingRows = w.staticRows = w.maxStaticRows = 0;
  w.feedback.clear();
  // ODE keeps pointers to the elements: the vector must not reallocate below.
  if (w.feedback.capacity() < step.contacts.size()) w.feedback.reserve(step.contacts.size() * 2);
  dContact contact{};
  for (const Contact& c : step.contacts) {
    if (!counts(c, step)) continue;
    const bool both = c.bodyA != kNone && c.bodyB != kNone;
    (both ? w.couplingRows : w.staticRows) += kContactRows;
    recordContact(w, c.bodyA, both ? 0 : kContactRows);
    recordContact(w, c.bodyB, both ? 0 : kContactRows);

    // The contact in ODE's form.
    setSurface(contact.surface, c.surface, w.exactReplay);
    for (int k = 0; k < 3; ++k) contact.geom.pos[k] = c.position[k], contact.geom.normal[k] = c.normal[k];
    contact.geom.depth = c.depth;

    // Its joint, with the bodies in the order of the geoms.
    const dJointID joint = dJointCreateContact(w.id, w.contactJoints, &contact);
    dJointAttach(joint, c.bodyA != kNone ? w.bodies[c.bodyA].body : nullptr,
                 c.bodyB != kNone ? w.bodies[c.bodyB].body : nullptr);
    if (!c.feedback) continue;
    w.feedback.push_back({});
    dJointSetFeedback(joint, &w.feedback.back());
  }
}

void readContacts(const WorldData& w, const engine::Step& step) {
  if (w.feedback.empty()) return;
  std::size_t next = 0;
  for (Contact& c : step.contacts) {
    if (!c.feedback || !counts(c, step)) continue;
    const Vec3 onFirst = toVec(w.feedback[next++].f1);
    // ODE reverses a joint whose first body is the world.
    c.forceOnA = c.bodyA == kNone ? Vec3(-onFirst) : onFirst;
  }
}

constexpr const char* kIslandFailed =
    "The island was not stepped: its bodies are put back to their last poses, at rest";

/// The bodies that ODE failed to move have no state: the physics server repairs it, and names them.
void abandon(WorldData& w, const engine::Step& step) {
  for (Index i = 0; i < w.bodies.size(); ++i) {
    if (!w.needed[i] || w.bodies[i].movedStep == w.steps) continue;
    DynamicState& s = step.state.bodies[i];
    s.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    s.force.setZero(), s.torque.setZero();
    s.awake = true;
    w.bodies[i].version = 0;
  }
}

}  // namespace

void OdeSolver::recover(const engine::Step& step, const std::string& failure) {
  WorldData& w = world_;
  // ODE may have changed the states and forces of the bodies that it did not move.
  for (Index i = 0; i < w.bodies.size(); ++i)
    if (w.needed[i] && w.bodies[i].movedStep != w.steps) w.bodies[i].version = 0;
  writeState(w, step);
  if (!w.exactReplay && excludeMoved(step)) {
    solveAgain(step);
    if (w.threads->takeFailure().empty()) return engine_.messages_.mend(engine_, failure);
  }
  abandon(w, step);
  engine_.messages_.fail(engine_, failure, kIslandFailed);
}

void OdeSolver::step(engine::Step& step) {
  WorldData& w = world_;
  const MessageCapture capture(engine_.messages_.last);
  ++w.steps;
  w.awake = findNeeded(w, step);
  if (w.awake == 0) return;
  passTurns(w, step.model, step.state);
  passStopReturns(w, step);
  passMotors(w, step.state);
  writeState(w, step);
  passLaws(w, step);
  addContactJoints(w, step);
  w.state = &step.state;
  std::string failure;
  try {
    solve(step);
    failure = w.threads->takeFailure();
  } catch (const Failure& f) {
    failure = f.what();
    w.threads->takeFailure();
  }
  if (!failure.empty()) recover(step, failure);
  for (const Index i : w.order) step.state.markMoved(i);
  readJoints(w, step);
  readContacts(w, step);
  dJointGroupEmpty(w.contactJoints);
  engine_.messages_.report(engine_);
}

}  // namespace spark::ode
