#include "raw_world.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include "api/agents.h"
#include "physics-ode/ode_engine.h"
#include "physics/collider.h"
#include "spark/error.h"

namespace spark::bench {

namespace {
/// The surface that two colliders' handlers give together (scene-language section 3.3).
dSurfaceParameters combine(const engine::Surface& a, const engine::Surface& b) {
  dSurfaceParameters s{};
  s.mu = (a.mu + b.mu) / 2;
  const auto mix = [&](int bit, dReal& value, bool onA, double va, bool onB, double vb) {
    if (!onA && !onB) return;
    s.mode |= bit;
    value = onA && onB ? (va + vb) / 2 : onA ? va : vb;
  };
  mix(dContactBounce, s.bounce, a.bounceOn, a.bounce, b.bounceOn, b.bounce);
  mix(dContactBounce, s.bounce_vel, a.bounceOn, a.bounceVelocity, b.bounceOn, b.bounceVelocity);
  mix(dContactSoftERP, s.soft_erp, a.softErpOn, a.softErp, b.softErpOn, b.softErp);
  mix(dContactSoftCFM, s.soft_cfm, a.softCfmOn, a.softCfm, b.softCfmOn, b.softCfm);
  mix(dContactSlip1, s.slip1, a.slipOn, a.slip1, b.slipOn, b.slip1);
  mix(dContactSlip2, s.slip2, a.slipOn, a.slip2, b.slipOn, b.slip2);
  return s;
}

bool same(const engine::Surface& a, const engine::Surface& b) {
  const dSurfaceParameters x = combine(a, a), y = combine(b, b);
  return std::memcmp(&x, &y, sizeof x) == 0;
}

const engine::Surface* surfaceOf(const Collider& c) {
  static const ContactJointHandler fallback;
  const Collider::Handlers& h = c.handlers();
  return h.contact ? h.contact->surface() : h.fallback ? fallback.surface() : nullptr;
}

ode::WorldData& worldOf(Kernel& kernel) {
  return *ode::data(kernel.root().require<IPhysicsServer>("/sys/server/physics").world());
}

dBodyID bodyOf(const IRigidBody& body, const ode::WorldData& w) {
  // Bodies do not tell their ids; no two stand at the same place, and numbers cross the engine's interface in single
  // precision at least.
  const Vec3 p = body.state().position;
  for (const auto& b : w.bodies)
    if (const dReal* q = dBodyGetPosition(b->id); (Vec3(q[0], q[1], q[2]) - p).cwiseAbs().maxCoeff() <= 4e-6)
      return b->id;
  throw Error("a body of the house is not in the engine");
}
}  // namespace

RawWorld::RawWorld(House& house) {
  ode::WorldData& w = worldOf(house.kernel());
  world_ = w.id;
  root_ = w.root;
  for (const auto& s : w.spaces)
    if (s->inner) spaces_.push_back(s->id);
  group_ = dJointGroupCreate(0);
  for (const auto& b : w.bodies) {
    dBodySetAutoDisableFlag(b->id, w.parameters.autoDisable ? 1 : 0);
    bodyIds_.push_back(b->id);
  }
  joints_ = static_cast<int>(w.joints.size());
  perPair_ = static_cast<int>(
      getProperty(house.kernel().root().require<Leaf>("/sys/server/physics"), "contactsPerPair").toInteger());
  step_ = getProperty(house.kernel().root().require<Leaf>("/sys/server/simulation"), "step").toNumber();
  // What needs the house's own view comes before geoms forget their owners.
  takeDrags(house.kernel());
  takeMotors(house);
  takeDrivers(house);
  takeGeoms(w.geoms);
}

void RawWorld::takeGeoms(const std::vector<std::unique_ptr<ode::GeomData>>& geoms) {
  std::vector<const engine::Surface*> kinds;
  std::map<std::string, std::vector<std::size_t>> byName;
  for (const auto& g : geoms) {
    const auto& owner = *static_cast<const Collider*>(g->owner);
    auto raw = std::make_unique<Geom>();
    if (const engine::Surface* s = surfaceOf(owner)) {
      const auto known =
          std::find_if(kinds.begin(), kinds.end(), [&](const engine::Surface* k) { return same(*k, *s); });
      raw->surface = static_cast<std::size_t>(known - kinds.begin());
      if (known == kinds.end()) kinds.push_back(s);
      raw->solid = true;
    }
    byName[owner.name()].push_back(geoms_.size());
    dGeomSetData(g->id, raw.get());
    geoms_.push_back(std::move(raw));
  }
  surfaceCount_ = kinds.size();
  for (const engine::Surface* a : kinds)
    for (const engine::Surface* b : kinds) surfaces_.push_back(combine(*a, *b));
  for (std::size_t i = 0; i < geoms.size(); ++i) {
    const Value names = getProperty(*static_cast<const Collider*>(geoms[i]->owner), "notCollideWith");
    for (const Value& name : names.toList())
      for (const std::size_t k : byName[name.toString()])
        if (geoms[i]->space == geoms[k]->space)
          geoms_[i]->never.push_back(geoms_[k].get()), geoms_[k]->never.push_back(geoms_[i].get());
  }
}

RawWorld::~RawWorld() { dJointGroupDestroy(group_); }

void RawWorld::takeDrags(Kernel& kernel) {
  const ode::WorldData& w = worldOf(kernel);
  std::vector<BodyController*> controllers;
  kernel.root().require<Node>("/usr/scene").collect(controllers);
  for (BodyController* c : controllers)
    if (c->classObject()->name() == "DragController" && c->ancestor<IRigidBody>())
      drags_.push_back({bodyOf(*c->ancestor<IRigidBody>(), w), getProperty(*c, "linearDrag").toNumber(),
                        getProperty(*c, "angularDrag").toNumber()});
}

/// The engine's joint is the one in which a number that nobody else has turns up.
const ode::JointData& jointOf(IJoint& joint, const ode::WorldData& w) {
  constexpr double kMark = 0.123046875;  // the same in single precision
  const double before = joint.parameter(engine::JointParameter::velocity, 0);
  joint.setParameter(engine::JointParameter::velocity, 0, kMark);
  const auto found = std::find_if(w.joints.begin(), w.joints.end(), [](const auto& j) {
    return (j->type == engine::JointType::hinge && dJointGetHingeParam(j->id, dParamVel) == kMark) ||
           (j->type == engine::JointType::universal && dJointGetUniversalParam(j->id, dParamVel) == kMark);
  });
  if (found == w.joints.end()) throw Error(joint.leaf().path() + " is not in the engine");
  joint.setParameter(engine::JointParameter::velocity, 0, before);
  return **found;
}

void RawWorld::takeMotors(House& house) {
  if (!house.world().humanoid() || house.world().motion == World::Motion::rest) return;
  const ode::WorldData& w = worldOf(house.kernel());
  for (const AgentAspect* agent : house.kernel().root().require<IGameControl>("/sys/server/gamecontrol").agents()) {
    std::vector<Effector*> effectors;
    agent->collect(effectors);
    for (const Effector* e : effectors) {
      const int index = motorIndex(e->predicate());
      IJoint* joint = e->parent()->as<IJoint>();
      if (index < 0 || !joint) continue;
      const ode::JointData& data = jointOf(*joint, w);
      const bool universal = data.type == engine::JointType::universal;
      for (int axis = 0; axis < (universal ? 2 : 1); ++axis) motors_.push_back({data.id, axis, universal, index});
    }
  }
}

void RawWorld::takeDrivers(House& house) {
  if (house.world().kind != World::Kind::spheres) return;
  const ode::WorldData& w = worldOf(house.kernel());
  std::size_t index = 0;
  for (const AgentAspect* agent : house.kernel().root().require<IGameControl>("/sys/server/gamecontrol").agents()) {
    std::vector<IRigidBody*> bodies;
    agent->collect(bodies);
    for (IRigidBody* b : bodies) drivers_.push_back({bodyOf(*b, w), index, index % 2 ? -60.0 : 60.0});
    ++index;
  }
}

void RawWorld::follow(House& house) {
  const ode::WorldData& w = worldOf(house.kernel());
  if (w.bodies.size() != bodyIds_.size())
    throw Error(fmt::format("expected {} bodies as in the house's twin, found {}", bodyIds_.size(), w.bodies.size()));
  for (std::size_t i = 0; i < bodyIds_.size(); ++i) {
    const dBodyID from = w.bodies[i]->id, to = bodyIds_[i];
    const dReal *p = dBodyGetPosition(from), *v = dBodyGetLinearVel(from), *r = dBodyGetAngularVel(from);
    dBodySetPosition(to, p[0], p[1], p[2]);
    dBodySetQuaternion(to, dBodyGetQuaternion(from));
    dBodySetLinearVel(to, v[0], v[1], v[2]);
    dBodySetAngularVel(to, r[0], r[1], r[2]);
    if (dBodyIsEnabled(from) && !dBodyIsEnabled(to)) dBodyEnable(to);
    if (!dBodyIsEnabled(from)) dBodyDisable(to);
  }
  cycle_ = house.cycles();
}

int RawWorld::awake() const {
  return static_cast<int>(
      std::count_if(bodyIds_.begin(), bodyIds_.end(), [](dBodyID b) { return dBodyIsEnabled(b) != 0; }));
}

std::pair<double, double> RawWorld::phases() {
  const auto mean = [this](std::chrono::steady_clock::duration& sum) {
    return timed_
               ? std::chrono::duration<double, std::micro>(std::exchange(sum, {})).count() / static_cast<double>(timed_)
               : 0.0;
  };
  const std::pair<double, double> out{mean(collide_), mean(solve_)};
  timed_ = 0;
  return out;
}

void RawWorld::act() {
  ++cycle_;
  for (const Motor& m : motors_) {
    const double v = motorSpeed(m.index, cycle_);
    if (m.universal)
      dJointSetUniversalParam(m.joint, dParamVel + dParamGroup * m.axis, v);
    else
      dJointSetHingeParam(m.joint, dParamVel, v);
    if (const dBodyID b = dJointGetBody(m.joint, 0); b && !dBodyIsEnabled(b)) dBodyEnable(b);
  }
  for (const Driver& d : drivers_) {
    dBodyEnable(d.body);
    dBodyAddForce(d.body, d.factor * drivePower(d.agent, cycle_, 0), d.factor * drivePower(d.agent, cycle_, 1), 0);
  }
  for (const Drag& d : drags_) {
    if (!dBodyIsEnabled(d.body)) continue;
    const dReal* v = dBodyGetLinearVel(d.body);
    const dReal* r = dBodyGetAngularVel(d.body);
    dBodyAddForce(d.body, -d.linear * v[0], -d.linear * v[1], -d.linear * v[2]);
    dBodyAddTorque(d.body, -d.angular * r[0], -d.angular * r[1], -d.angular * r[2]);
  }
}

void RawWorld::nearCallback(void* self, dGeomID a, dGeomID b) {
  if (dGeomIsSpace(a) || dGeomIsSpace(b))
    dSpaceCollide2(a, b, self, nearCallback);
  else
    static_cast<RawWorld*>(self)->near(a, b);
}

void RawWorld::near(dGeomID a, dGeomID b) {
  const dBodyID bodyA = dGeomGetBody(a), bodyB = dGeomGetBody(b);
  if (!bodyA && !bodyB) return;
  const Geom& ga = *static_cast<const Geom*>(dGeomGetData(a));
  const Geom& gb = *static_cast<const Geom*>(dGeomGetData(b));
  if (!ga.solid || !gb.solid) return;
  if (bodyA && bodyB && dAreConnectedExcluding(bodyA, bodyB, dJointTypeContact)) return;
  if (!ga.never.empty() && std::find(ga.never.begin(), ga.never.end(), &gb) != ga.never.end()) return;
  dContact found[16];
  const int n = dCollide(a, b, perPair_, &found[0].geom, sizeof(dContact));
  for (int i = 0; i < n; ++i) {
    found[i].surface = surfaces_[ga.surface * surfaceCount_ + gb.surface];
    dJointAttach(dJointCreateContact(world_, group_, &found[i]), bodyA, bodyB);
  }
  contacts_ += n;
}

void RawWorld::run(std::int64_t cycles) {
  using Clock = std::chrono::steady_clock;
  for (std::int64_t i = 0; i < cycles; ++i) {
    act();
    contacts_ = 0;
    const auto begin = Clock::now();
    dSpaceCollide(root_, this, nearCallback);
    for (const dSpaceID s : spaces_) dSpaceCollide(s, this, nearCallback);
    const auto between = Clock::now();
    dWorldStep(world_, step_);
    collide_ += between - begin;
    solve_ += Clock::now() - between;
    dJointGroupEmpty(group_);
  }
  timed_ += cycles;
}

}  // namespace spark::bench
