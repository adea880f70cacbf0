#include "raw_world.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include "api/agents.h"
#include "physics-ode/ode_collision.h"
#include "physics-ode/ode_engine.h"
#include "physics/collider.h"
#include "spark/error.h"

namespace spark::bench {

struct RawWorld::Source {
  const engine::Model& model;
  const ode::WorldData& dynamics;
  const ode::CollisionWorld& collision;
  explicit Source(Instance& instance);
  dBodyID bodyOf(const IRigidBody& body) const;
  engine::Index indexOf(const IRigidBody* body) const;
  engine::Index indexOf(IJoint& joint) const;
};

namespace {
/// The combined surface of two colliders' handlers (scene-language section 3.3).
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

IPhysicsServer& serverOf(Instance& instance) {
  return instance.kernel().root().require<IPhysicsServer>(IPhysicsServer::kPath);
}

const std::vector<AgentAspect*>& agentsOf(Instance& instance) {
  return instance.kernel().root().require<IGameControl>("/sys/server/gamecontrol").agents();
}

/// What a node has made for the only world.
template <class Part, class Maker>
const Part& partOf(const Maker& maker) {
  if (maker.parts().size() != 1) throw Error(fmt::format("expected one world, found {}", maker.parts().size()));
  return static_cast<const Part&>(*maker.parts().front());
}
}  // namespace

// ---- taking over an instance ----

RawWorld::Source::Source(Instance& instance)
    : model(serverOf(instance).model()),
      dynamics(
          partOf<ode::OdeSolver>(instance.kernel().root().require<OdeEngine>("/sys/server/physics/engine")).world()),
      collision(
          partOf<ode::OdeDetector>(instance.kernel().root().require<OdeCollision>("/sys/server/physics/collision"))
              .world()) {
  const auto expect = [&](const char* what, std::size_t found, std::size_t wanted) {
    if (found != wanted)
      throw Error(fmt::format("{}: expected {} {} in ODE as in the model, found {}", instance.world().name, wanted,
                              what, found));
  };
  expect("bodies", dynamics.bodies.size(), model.bodies.size());
  expect("joints", dynamics.joints.size(), model.joints.size());
  expect("spaces", collision.spaces.size(), model.spaces.size());
  expect("geoms", collision.geoms.size(), model.geoms.size());
}

engine::Index RawWorld::Source::indexOf(const IRigidBody* body) const {
  if (!body) return engine::kNone;
  const auto& node = static_cast<const RigidBody&>(*body);
  return node.world()->index(node.handle());
}

dBodyID RawWorld::Source::bodyOf(const IRigidBody& body) const { return dynamics.bodies.at(indexOf(&body)).body; }

/// The joint of the same type between the same bodies. Robots do not have two such joints.
engine::Index RawWorld::Source::indexOf(IJoint& joint) const {
  engine::Index a = indexOf(joint.body(0)), b = indexOf(joint.body(1));
  if (a == engine::kNone) std::swap(a, b);
  const auto is = [&](const engine::Joint& j) { return j.type == joint.jointType() && j.a == a && j.b == b; };
  const auto found = std::find_if(model.joints.begin(), model.joints.end(), is);
  if (found == model.joints.end() || std::find_if(std::next(found), model.joints.end(), is) != model.joints.end())
    throw Error(fmt::format("{}: expected one joint of its type between its bodies", joint.leaf().path()));
  return static_cast<engine::Index>(found - model.joints.begin());
}

RawWorld::RawWorld(Instance& instance) {
  const Source from(instance);
  world_ = from.dynamics.id;
  root_ = from.collision.root;
  group_ = dJointGroupCreate(0);
  joints_ = static_cast<int>(from.dynamics.joints.size());
  perPair_ = static_cast<int>(
      getProperty(instance.kernel().root().require<Leaf>("/sys/server/physics"), "contactsPerPair").toInteger());
  step_ = getProperty(instance.kernel().root().require<Leaf>("/sys/server/simulation"), "step").toNumber();
  takeBodies(from);
  takeGeoms(from);
  takeSurfaces(from);
  takeDrags(instance, from);
  takeMotors(instance, from);
  takeDrivers(instance, from);
  follow(instance);
}

void RawWorld::takeBodies(const Source& from) {
  for (const ode::BodyData& b : from.dynamics.bodies) {
    dBodySetAutoDisableFlag(b.body, from.model.parameters.autoDisable ? 1 : 0);
    bodyIds_.push_back(b.body);
  }
}

void RawWorld::takeGeoms(const Source& from) {
  for (const auto& s : from.collision.spaces)
    if (s->inner) spaces_.push_back(s->space);
  for (const auto& g : from.collision.geoms) {
    // The host's geoms have no bodies in ODE: the host sets their poses itself.
    if (g->body != engine::kNone) {
      dGeomSetBody(g->geom, bodyIds_[g->body]);
      if (!g->centred) {
        dMatrix3 rotation;
        ode::toOde(g->offset.rotation, rotation);
        const Vec3& p = g->offset.position;
        dGeomSetOffsetPosition(g->geom, p.x(), p.y(), p.z());
        dGeomSetOffsetRotation(g->geom, rotation);
      }
    }
    geoms_.push_back(std::make_unique<Geom>());
    dGeomSetData(g->geom, geoms_.back().get());
  }
}

void RawWorld::takeSurfaces(const Source& from) {
  const std::vector<engine::Geom>& geoms = from.model.geoms;
  std::vector<const engine::Surface*> kinds;
  std::map<std::string, std::vector<std::size_t>> byName;
  for (std::size_t i = 0; i < geoms.size(); ++i) {
    const auto& owner = *static_cast<const Collider*>(geoms[i].owner);
    byName[owner.name()].push_back(i);
    const engine::Surface* s = surfaceOf(owner);
    if (!s) continue;
    const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const engine::Surface* k) { return same(*k, *s); });
    geoms_[i]->surface = static_cast<std::size_t>(known - kinds.begin());
    if (known == kinds.end()) kinds.push_back(s);
    geoms_[i]->solid = true;
  }
  surfaceCount_ = kinds.size();
  for (const engine::Surface* a : kinds)
    for (const engine::Surface* b : kinds) surfaces_.push_back(combine(*a, *b));

  // Pairs that exclude each other by name.
  for (std::size_t i = 0; i < geoms.size(); ++i) {
    const Value names = getProperty(*static_cast<const Collider*>(geoms[i].owner), "notCollideWith");
    for (const Value& name : names.toList())
      for (const std::size_t k : byName[name.toString()])
        if (geoms[i].space == geoms[k].space)
          geoms_[i]->never.push_back(geoms_[k].get()), geoms_[k]->never.push_back(geoms_[i].get());
  }
}

RawWorld::~RawWorld() { dJointGroupDestroy(group_); }

void RawWorld::takeDrags(Instance& instance, const Source& from) {
  std::vector<BodyController*> controllers;
  instance.kernel().root().require<Node>("/usr/scene").collect(controllers);
  for (BodyController* c : controllers)
    if (c->classObject()->name() == "DragController" && c->ancestor<IRigidBody>())
      drags_.push_back({from.bodyOf(*c->ancestor<IRigidBody>()), getProperty(*c, "linearDrag").toNumber(),
                        getProperty(*c, "angularDrag").toNumber()});
}

void RawWorld::takeMotors(Instance& instance, const Source& from) {
  if (!instance.world().humanoid() || instance.world().motion == World::Motion::rest) return;
  for (const AgentAspect* agent : agentsOf(instance)) {
    std::vector<Effector*> effectors;
    agent->collect(effectors);
    for (const Effector* e : effectors) {
      const int index = motorIndex(e->predicate());
      IJoint* joint = e->parent()->as<IJoint>();
      if (index < 0 || !joint) continue;
      const dJointID id = from.dynamics.joints[from.indexOf(*joint)]->joint;
      const bool universal = joint->jointType() == engine::JointType::universal;
      for (int axis = 0; axis < (universal ? 2 : 1); ++axis) motors_.push_back({id, axis, universal, index});
    }
  }
}

void RawWorld::takeDrivers(Instance& instance, const Source& from) {
  if (instance.world().kind != World::Kind::spheres) return;
  std::size_t index = 0;
  for (const AgentAspect* agent : agentsOf(instance)) {
    std::vector<IRigidBody*> bodies;
    agent->collect(bodies);
    for (IRigidBody* b : bodies) drivers_.push_back({from.bodyOf(*b), index, index % 2 ? -60.0 : 60.0});
    ++index;
  }
}

// ---- stepping ----

void RawWorld::follow(Instance& instance) {
  const std::vector<engine::DynamicState>& states = serverOf(instance).state().bodies;
  if (states.size() != bodyIds_.size())
    throw Error(fmt::format("expected {} bodies as in the equal instance, found {}", bodyIds_.size(), states.size()));
  for (std::size_t i = 0; i < bodyIds_.size(); ++i) {
    const dBodyID to = bodyIds_[i];
    const engine::DynamicState& s = states[i];
    const Vec3 &p = s.position, &v = s.linearVelocity, &r = s.angularVelocity;
    dBodySetPosition(to, p.x(), p.y(), p.z());
    dBodySetQuaternion(to, s.quaternion.data());
    dBodySetLinearVel(to, v.x(), v.y(), v.z());
    dBodySetAngularVel(to, r.x(), r.y(), r.z());
    if (s.awake && !dBodyIsEnabled(to)) dBodyEnable(to);
    if (!s.awake) dBodyDisable(to);
  }
  cycle_ = instance.cycles();
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
