#include "mujoco_world.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "api/joined_bodies.h"
#include "mjcf_constraints.h"

namespace spark::mujoco {

using engine::Contact;
using engine::DynamicState;
using engine::Joint;
using engine::JointType;
using engine::Model;
using engine::State;

namespace {

const DynamicState& worldState() {
  static const DynamicState state;
  return state;
}

/// The angle of a rotation about `axis`, of length 1 [rad, -pi..pi].
double angleAbout(const Mat3& rotation, const Vec3& axis) {
  const Eigen::Quaterniond q(rotation);
  const double angle = 2 * std::atan2(q.vec().dot(axis), q.w());
  // What the rounding of rotations leaves of 0 would decide whether a stop at 0 acts.
  if (std::abs(angle) < 1e-15) return 0;
  return angle > kPi ? angle - 2 * kPi : angle < -kPi ? angle + 2 * kPi : angle;
}

}  // namespace

namespace {
/// Has the system provide the pages of a block of memory now, not when they are first used.
void touch(void* block, std::size_t bytes) {
  constexpr std::size_t kPage = 4096;
  auto* const p = static_cast<volatile char*>(block);
  for (std::size_t i = 0; i < bytes; i += kPage) p[i] = p[i];
}
}  // namespace

Compiled compileWorld(Written world, bool ahead) {
  Compiled c;
  c.model = compile(world.mjcf);
  c.raised = std::move(world.raised);
  c.data.reset(mj_makeData(c.model.get()));
  if (!c.data) throw Error("MuJoCo has no memory for the world");
  const mjModel& m = *c.model;
  const auto number = [&m](std::unordered_map<std::string, int>& out, int count, const int* addresses) {
    for (int i = 0; i < count; ++i) out.emplace(m.names + addresses[i], i);
  };
  number(c.bodies, m.nbody, m.name_bodyadr);
  number(c.joints, m.njnt, m.name_jntadr);
  number(c.geoms, m.ngeom, m.name_geomadr);
  if (!ahead) return c;
  touch(c.data->buffer, static_cast<std::size_t>(c.data->nbuffer));
  touch(c.data->stack, static_cast<std::size_t>(c.data->nstack) * sizeof(mjtNum));
  return c;
}

namespace {
/// Writes the heights of a field to MuJoCo's, which are 0 to 1.
void takeHeights(mjModel& m, int geom, const engine::ShapeDescription& shape) {
  if (!shape.heightField || m.geom_type[geom] != mjGEOM_HFIELD) return;
  const engine::HeightField& f = *shape.heightField;
  const int field = m.geom_dataid[geom];
  if (m.hfield_ncol[field] != f.columns || m.hfield_nrow[field] != f.rows) return;
  const auto span = static_cast<float>(spanOf(f));
  for (std::size_t i = 0; i < f.heights.size(); ++i)
    m.hfield_data[static_cast<std::size_t>(m.hfield_adr[field]) + i] = (f.heights[i] - f.low) / span;
}
}  // namespace

MujocoWorld::MujocoWorld(const Model& model, Trees trees, Compiled compiled, const MeshPieces& pieces)
    : trees_(std::move(trees)), m_(std::move(compiled.model)), d_(std::move(compiled.data)) {
  placeConstraints(model, *m_);
  linkOrigins_.resize(static_cast<std::size_t>(m_->nbody), Vec3::Zero());
  hasParts_.resize(static_cast<std::size_t>(m_->nbody), 0);
  const auto id = [](const std::unordered_map<std::string, int>& numbers, const std::string& name) {
    const auto found = numbers.find(name);
    return found == numbers.end() ? -1 : found->second;
  };
  for (Index i = 0; i < trees_.links.size(); ++i) {
    const Link& link = trees_.links[i];
    rootOf_.push_back(link.parent == kNone ? i : rootOf_[link.parent]);
    Origin& from = origins_.emplace_back();
    from.body = model.bodies[link.body].id;
    from.mujocoBody = id(compiled.bodies, bodyName(link.body));
    if (from.mujocoBody >= 0)
      linkOrigins_[static_cast<std::size_t>(from.mujocoBody)] = model.bodies[link.body].linkOrigin;
    for (std::size_t part = 1; part < model.bodies[link.body].parts.size(); ++part)
      if (const int at = id(compiled.bodies, partName(link.body, part)); at >= 0) {
        from.parts.push_back(at);
        hasParts_[static_cast<std::size_t>(from.mujocoBody)] = 1;
      }
    if (link.joint == kNone) {
      const engine::Body& b = model.bodies[link.body];
      for (int k = 0, dof = m_->body_dofadr[from.mujocoBody]; k < 6; ++k)
        m_->dof_damping[dof + k] = k < 3 ? b.linearDamping : b.angularDamping;
      continue;
    }
    const Joint& j = model.joints[link.joint];
    from.joint = j.id;
    from.attachedAt = j.attachedAt;
    for (int c = 0; c < coordinatesOf(j.type); ++c) {
      const int joint = id(compiled.joints, jointName(link.joint, c));
      from.joints.push_back(joint);
      if (j.type != JointType::ball) from.mujocoJoints[c] = joint;
    }
    std::sort(from.joints.begin(), from.joints.end());
  }
  if (hasActuators(model)) {
    actuators_.assign(static_cast<std::size_t>(m_->njnt), -1);
    // The first ones are those of coordinates.
    for (int i = 0; i < m_->nu && m_->names[m_->name_actuatoradr[i]] == 'j'; ++i)
      actuators_[static_cast<std::size_t>(m_->actuator_trnid[2 * i])] = i;
  }
  for (const auto& [number, n] : model.extensions.world.all<ActuatorNumbers>(kConstraintNumbers))
    if (const int i = mj_name2id(m_.get(), mjOBJ_ACTUATOR, actuatorName(number).c_str()); i >= 0)
      inputs_.emplace_back(engine::Block::kindOf<ActuatorNumbers>(number), i);
  geoms_.assign(m_->ngeom, 0);
  for (Index i = 0; i < model.geoms.size(); ++i) {
    if (const int geom = id(compiled.geoms, geomName(i)); geom >= 0) {
      geoms_[geom] = model.geoms[i].id;
      takeHeights(*m_, geom, model.geoms[i].shape);
    }
    if (model.geoms[i].shape.shape != engine::Shape::mesh) continue;
    for (std::size_t piece = 0;; ++piece) {
      const int geom = id(compiled.geoms, pieceName(i, piece));
      if (geom < 0) break;
      geoms_[geom] = model.geoms[i].id;
      pieceContacts_.add(*m_, geom, model.geoms[i].offset.rotation * pieces.frontOf(model.geoms[i], piece));
    }
  }

  wrenches_.resize(static_cast<std::size_t>(m_->nbody));
  resistances_.resize(static_cast<std::size_t>(m_->nv));
  mobilities_.resize(static_cast<std::size_t>(m_->nv));
  for (int body = 0; body < m_->nbody; ++body) {
    const Vec3 i = toVec(m_->body_inertia + 3 * body);
    const double mass = std::max(m_->body_mass[body], mjMINVAL);
    Vec3& edges = boxes_.emplace_back();
    for (int k = 0; k < 3; ++k) edges[k] = std::sqrt(std::max(mjMINVAL, i.sum() - 2 * i[k]) / mass * 6);
  }
  taken_.assign(trees_.links.size(), 0);
  bind(model);
}

void MujocoWorld::bind(const Model& model) {
  // Trees of which something was removed or attached elsewhere move no more.
  std::vector<std::uint8_t> gone(trees_.links.size(), 0);
  for (Index i = 0; i < trees_.links.size(); ++i) {
    Link& link = trees_.links[i];
    const Origin& from = origins_[i];
    link.body = engine::indexOf(model.bodies, from.body);
    link.joint = from.joint == 0 ? kNone : engine::indexOf(model.joints, from.joint);
    const bool same =
        link.body != kNone &&
        (from.joint == 0 || (link.joint != kNone && model.joints[link.joint].attachedAt == from.attachedAt));
    if (!same) gone[rootOf_[i]] = 1;
  }
  bodyId_.assign(model.bodies.size(), -1);
  linkOf_.assign(model.bodies.size(), kNone);
  motors_.assign(m_->nv, {});
  coordinates_.assign(model.joints.size(), {});
  for (Index i = 0; i < trees_.links.size(); ++i) {
    Link& link = trees_.links[i];
    if (gone[rootOf_[i]]) link.body = link.joint = kNone;
    if (link.body == kNone) continue;
    linkOf_[link.body] = i;
    bodyId_[link.body] = origins_[i].mujocoBody;  // -1: a connector without a body of its own
    if (link.joint == kNone) continue;
    bindMotors(model.joints[link.joint], link.joint, origins_[i].mujocoJoints);
  }
  options_ = optionsOf(model);
  ownDrag_ = hasOwnDrag(model);
  joined_.clear();
  engine::forEachJoined(model, [&](Index a, Index b) { joined_.push_back(pairOf(a, b)); });
  std::sort(joined_.begin(), joined_.end());
  geomOf_.assign(geoms_.size(), kNone);
  for (std::size_t i = 0; i < geoms_.size(); ++i) {
    const Index geom = geoms_[i] == 0 ? kNone : engine::indexOf(model.geoms, geoms_[i]);
    if (geom == kNone || (model.geoms[geom].body != kNone && bodyId_[model.geoms[geom].body] < 0)) continue;
    geomOf_[i] = geom;
  }
  chosen_.clear();
  for (const auto& [number, n] : model.extensions.world.all<PairNumbers>(kConstraintNumbers)) {
    const Index first = engine::indexOf(model.geoms, n.first), second = engine::indexOf(model.geoms, n.second);
    if (n.first != 0 && n.second != 0 && first != kNone && second != kNone) chosen_.push_back(pairOf(first, second));
  }
  std::sort(chosen_.begin(), chosen_.end());
  prepared_ = false;
}

void MujocoWorld::takeActivations(const MujocoWorld& before) {
  // The actuators with an activation are MuJoCo's last ones.
  const auto at = [](const mjModel& m, int actuator) { return actuator - (m.nu - m.na); };
  for (const auto& [kind, actuator] : inputs_)
    for (const auto& [old, from] : before.inputs_)
      if (old == kind && at(*m_, actuator) >= 0 && at(*before.m_, from) >= 0)
        d_->act[at(*m_, actuator)] = before.d_->act[at(*before.m_, from)];
}

void MujocoWorld::bindMotors(const Joint& j, Index joint, const std::array<int, 3>& mujocoJoints) {
  for (int c = 0; c < 3; ++c) {
    const int id = mujocoJoints[c];
    // Of a wheel the suspension has no motor.
    const int axis = j.type == JointType::hinge2 ? c - 1 : c;
    if (id < 0 || axis < 0) continue;
    motors_[m_->jnt_dofadr[id]] = {joint, axis};
    // The axes of the model's angles change places in a reversed universal joint, and some angles their sign.
    const bool reversedUniversal = j.type == JointType::universal && j.reversed;
    const int angle = reversedUniversal ? 1 - axis : axis;
    const bool opposite = j.type == JointType::hinge2 ? axis == 1
                          : reversedUniversal         ? angle == 1
                                                      : j.type == JointType::hinge && j.reversed;
    coordinates_[joint][angle] = {id, opposite ? -1.0 : 1.0};
  }
}

bool MujocoWorld::isFull() const {
  return d_->warning[mjWARN_CONTACTFULL].number > 0 || d_->warning[mjWARN_CNSTRFULL].number > 0;
}

// ---- state ----

bool MujocoWorld::take(const Model& model, const State& state) {
  // What was written in one body of a tree concerns the coordinates of all.
  stale_.assign(trees_.links.size(), 0);
  bool any = false;
  for (Index i = 0; i < trees_.links.size(); ++i)
    if (const Index body = trees_.links[i].body; body != kNone && state.bodies[body].version != taken_[i])
      stale_[rootOf_[i]] = 1, any = true;
  if (!any) return false;
  for (Index i = 0; i < trees_.links.size(); ++i)
    if (stale_[rootOf_[i]] && trees_.links[i].body != kNone) takeLink(model, state, i);
  for (Index i = 0; i < trees_.links.size(); ++i)
    if (const Index body = trees_.links[i].body; body != kNone) taken_[i] = state.bodies[body].version;
  return true;
}

void MujocoWorld::takeLink(const Model& model, const State& state, Index index) {
  const Link& link = trees_.links[index];
  const DynamicState& child = state.bodies[link.body];
  const DynamicState& parent = link.parent == kNone ? worldState() : state.bodies[trees_.links[link.parent].body];
  const Mat3 delta = link.zero.rotation.transpose() * parent.rotation.transpose() * child.rotation;
  const Vec3 spin = child.angularVelocity - parent.angularVelocity;
  int hinges[2], hingeCount = 0;
  int free = 0;
  std::span<const int> joints = origins_[index].joints;
  if (link.joint == kNone) free = m_->body_jntadr[bodyId_[link.body]], joints = {&free, 1};
  for (const int i : joints) {
    mjtNum *q = d_->qpos + m_->jnt_qposadr[i], *v = d_->qvel + m_->jnt_dofadr[i];
    switch (m_->jnt_type[i]) {
      case mjJNT_FREE: {
        const Vec3 arm = child.rotation * linkOrigins_[static_cast<std::size_t>(bodyId_[link.body])];
        const Vec3 position = child.position + arm;
        std::copy_n(position.data(), 3, q);
        std::copy_n(child.quaternion.data(), 4, q + 3);
        const Vec3 local = child.rotation.transpose() * child.angularVelocity;
        const Vec3 velocity = child.linearVelocity + child.angularVelocity.cross(arm);
        std::copy_n(velocity.data(), 3, v);
        std::copy_n(local.data(), 3, v + 3);
        break;
      }
      case mjJNT_BALL: {
        const Eigen::Quaterniond rotation(delta);
        const Vec3 local = child.rotation.transpose() * spin;
        q[0] = rotation.w(), q[1] = rotation.x(), q[2] = rotation.y(), q[3] = rotation.z();
        std::copy_n(local.data(), 3, v);
        break;
      }
      case mjJNT_SLIDE: {
        // From where the parent holds the anchor to where the child has it, along the joint's axis 1.
        const Joint& j = model.joints[link.joint];
        const double sign = j.type == JointType::slider && j.reversed ? -1 : 1;
        const DynamicState &a = link.childIsA ? child : parent, &b = link.childIsA ? parent : child;
        const Vec3 axis = a.rotation * j.inA.axis[0];
        const Vec3 armA = j.type == JointType::slider ? Vec3(Vec3::Zero()) : Vec3(a.rotation * j.inA.anchor);
        const Vec3 armB = b.rotation * j.inB.anchor;
        q[0] = sign * axis.dot(a.position + armA - b.position - armB);
        v[0] = sign * axis.dot(a.linearVelocity + a.angularVelocity.cross(armA) - b.linearVelocity -
                               b.angularVelocity.cross(armB));
        break;
      }
      default:
        hinges[hingeCount++] = i;
        break;
    }
  }
  if (hingeCount == 0) return;
  const auto axis = [&](int i) { return Vec3(link.carrierInLink.rotation * toVec(m_->jnt_axis + 3 * i)); };
  // Poses do not say how often a joint has turned.
  const auto setAngle = [&](int i, double angle) {
    const DofMotor& at = motors_[m_->jnt_dofadr[i]];
    const double sign = model.joints[at.joint].type == JointType::hinge2 && at.axis == 1 ? -1 : 1;
    d_->qpos[m_->jnt_qposadr[i]] =
        engine::nearestTurn(angle, sign * state.coordinates[at.joint].at(static_cast<std::size_t>(at.axis)));
  };
  if (hingeCount == 1) {
    setAngle(hinges[0], angleAbout(delta, axis(hinges[0])));
    d_->qvel[m_->jnt_dofadr[hinges[0]]] = spin.dot(child.rotation * axis(hinges[0]));
    return;
  }
  // Two perpendicular axes: in the frame of both, delta is a rotation about x, then one about y.
  const Vec3 x = axis(hinges[0]), y = axis(hinges[1]);
  Mat3 frame;
  frame << x, y, x.cross(y);
  const Mat3 r = frame.transpose() * delta * frame;
  setAngle(hinges[0], std::atan2(r(2, 1), r(1, 1)));
  setAngle(hinges[1], std::atan2(r(0, 2), r(0, 0)));
  d_->qvel[m_->jnt_dofadr[hinges[0]]] = spin.dot(parent.rotation * link.zero.rotation * x);
  d_->qvel[m_->jnt_dofadr[hinges[1]]] = spin.dot(child.rotation * y);
}

void MujocoWorld::giveConnector(const Model& model, State& state, Index index) {
  const Link& link = trees_.links[index];
  const Joint& j = model.joints[link.joint];
  const DynamicState& parent = link.parent == kNone ? worldState() : state.bodies[trees_.links[link.parent].body];
  DynamicState& s = state.bodies[link.body];
  const int id = origins_[index].joints.front();
  const double q = d_->qpos[m_->jnt_qposadr[id]], rate = d_->qvel[m_->jnt_dofadr[id]];
  const Pose zero = compose({parent.position, parent.rotation}, link.zero);
  const Vec3 along = zero.rotation * link.carrierInLink.rotation * toVec(m_->jnt_axis + 3 * id);
  if (j.type == JointType::slider) {
    s.rotation = zero.rotation;
    s.position = zero.position + q * along;
    s.angularVelocity = parent.angularVelocity;
    s.linearVelocity =
        parent.linearVelocity + parent.angularVelocity.cross(s.position - parent.position) + rate * along;
  } else {
    const Vec3 anchor = zero.position + zero.rotation * (link.childIsA ? j.inA.anchor : j.inB.anchor);
    const Mat3 turn = Eigen::AngleAxisd(q, along).toRotationMatrix();
    s.rotation = turn * zero.rotation;
    s.position = anchor + turn * (zero.position - anchor);
    s.angularVelocity = parent.angularVelocity + rate * along;
    s.linearVelocity = parent.linearVelocity + parent.angularVelocity.cross(anchor - parent.position) +
                       s.angularVelocity.cross(s.position - anchor);
  }
  const Eigen::Quaterniond rotation(s.rotation);
  s.quaternion = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
  given(state, link.body);
}

void MujocoWorld::given(State& state, Index body) {
  DynamicState& s = state.bodies[body];
  s.awake = true;
  taken_[linkOf_[body]] = ++s.version;
  state.markMoved(body);
}

void MujocoWorld::give(const Model& model, State& state) {
  for (Index i = 0; i < state.bodies.size(); ++i) {
    DynamicState& s = state.bodies[i];
    s.force.setZero();
    s.torque.setZero();
    const int id = bodyId_[i];
    if (id < 0) continue;
    s.position = centreOf(id);
    std::copy_n(d_->xquat + 4 * id, 4, s.quaternion.begin());
    s.rotation = rotationOf(s.quaternion);
    s.angularVelocity = toVec(d_->cvel + 6 * id);
    s.linearVelocity = velocityOf(id, s.position);
    given(state, i);
  }
  // Parents come first.
  for (Index i = 0; i < trees_.links.size(); ++i)
    if (trees_.links[i].carrier != kNone && trees_.links[i].body != kNone) giveConnector(model, state, i);
}

Vec3 MujocoWorld::centreOf(int body) const {
  if (!hasParts_[static_cast<std::size_t>(body)]) return toVec(d_->xipos + 3 * body);
  return toVec(d_->xpos + 3 * body) - rotationAt(d_->xmat + 9 * body) * linkOrigins_[static_cast<std::size_t>(body)];
}

Vec3 MujocoWorld::armOf(int body, const Vec3& point) const {
  return point - toVec(d_->subtree_com + 3 * m_->body_rootid[body]);
}

Vec3 MujocoWorld::velocityOf(int body, const Vec3& point) const {
  const mjtNum* spatial = d_->cvel + 6 * body;  // rotation, translation at the tree's centre of mass
  return toVec(spatial + 3) + toVec(spatial).cross(armOf(body, point));
}

// ---- steps ----

bool MujocoWorld::run(engine::Step& step) {
  const auto bad = [&] {
    return d_->warning[mjWARN_BADQPOS].number + d_->warning[mjWARN_BADQVEL].number + d_->warning[mjWARN_BADQACC].number;
  };
  if (passMotors(step.state)) prepareAgain(step.model);
  findUnsolved(step.contacts);
  model_ = &step.model, state_ = &step.state;
  const bool stages = m_->opt.integrator == mjINT_RK4;
  const Session session(message_, m_.get(), mayTouch, this, stages ? onStage : nullptr, &pieceContacts_);
  passInputs(step.state);
  act();
  if (stages) {
    integrate(step);
  } else {
    mj_step2(m_.get(), d_.get());
    readContactForces(step.contacts);
  }
  if (bad() > 0) return false;
  // Places and velocities of the bodies; the next detect() finds contacts.
  mj_kinematics(m_.get(), d_.get());
  mj_comPos(m_.get(), d_.get());
  mj_comVel(m_.get(), d_.get());
  prepared_ = false;
  return true;
}

void MujocoWorld::act() {
  releaseUnsolved();
  passSpeeds(*state_);
  applyForces(*model_, *state_);
  applyLaws(*state_);
}

void MujocoWorld::onStage(void* world) {
  auto& w = *static_cast<MujocoWorld*>(world);
  w.findSpare();
  w.act();
}

void MujocoWorld::integrate(engine::Step& step) {
  mj_fwdActuation(m_.get(), d_.get());
  mj_fwdAcceleration(m_.get(), d_.get());
  mj_fwdConstraint(m_.get(), d_.get());
  mj_checkAcc(m_.get(), d_.get());
  readContactForces(step.contacts);
  mj_RungeKutta(m_.get(), d_.get(), 4);
}

void MujocoWorld::stopBadTree(State& state, std::vector<Index>& stopped) {
  int dof = -1;
  for (const int kind : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
    mjWarningStat& w = d_->warning[kind];
    // A place among the positions stands for its joint's first degree of freedom.
    if (w.number > 0 && kind != mjWARN_BADQPOS) dof = w.lastinfo;
    if (w.number > 0 && kind == mjWARN_BADQPOS)
      for (int j = 0; j < m_->njnt; ++j)
        if (m_->jnt_qposadr[j] <= w.lastinfo) dof = m_->jnt_dofadr[j];
    w = {};
  }
  const int body = dof >= 0 && dof < m_->nv ? m_->dof_bodyid[dof] : -1;
  const auto found =
      std::find_if(origins_.begin(), origins_.end(), [&](const Origin& o) { return o.mujocoBody == body; });
  for (Index i = 0; i < trees_.links.size(); ++i) {
    // Without a culprit all are stopped.
    const bool bad =
        found == origins_.end() || rootOf_[i] == rootOf_[static_cast<std::size_t>(found - origins_.begin())];
    if (!bad || trees_.links[i].body == kNone) continue;
    DynamicState& s = state.bodies[trees_.links[i].body];
    for (Vec3* v : {&s.linearVelocity, &s.angularVelocity, &s.force, &s.torque}) v->setZero();
    stopped.push_back(trees_.links[i].body);
  }
}

void MujocoWorld::step(engine::Step& step) {
  if (take(step.model, step.state) || !prepared_) prepareAgain(step.model);
  std::vector<Index> stopped;
  while (!run(step) && stopped.size() < 2 * step.state.bodies.size()) {
    stopBadTree(step.state, stopped);
    mj_resetData(m_.get(), d_.get());
    taken_.assign(taken_.size(), 0);
    take(step.model, step.state);
    prepareAgain(step.model);
  }
  give(step.model, step.state);
  // The physics server puts bodies back whose speed is none.
  for (const Index i : stopped) step.state.bodies[i].linearVelocity.setConstant(HUGE_VAL);
}

// ---- snapshots ----

/// Calls `f` for each number that lasts from step to step.
template <class F>
void MujocoWorld::forEachNumber(F f) const {
  for (int i = 0; i < m_->nq; ++i) f(d_->qpos[i]);
  for (int i = 0; i < m_->nv; ++i) f(d_->qvel[i]);
  for (int i = 0; i < m_->nv; ++i) f(d_->qacc_warmstart[i]);
  for (int i = 0; i < m_->nv; ++i) f(m_->dof_frictionloss[i]);
  for (int i = 0; i < m_->na; ++i) f(d_->act[i]);
}

void MujocoWorld::save(const State& state, StateWriter& out) const {
  out.write(std::int64_t{m_->nq} + 3 * m_->nv + m_->na);
  forEachNumber([&out](const mjtNum& v) { out.write(v); });
  out.write(static_cast<std::int64_t>(trees_.links.size()));
  for (Index i = 0; i < trees_.links.size(); ++i) {
    const Index body = trees_.links[i].body;
    out.write(body != kNone && state.bodies[body].version == taken_[i]);
  }
}

MujocoWorld::Saved::Saved(StateReader& in) {
  numbers.resize(in.readCount());
  for (double& v : numbers) v = in.readNumber();
  taken.resize(in.readCount());
  for (std::uint8_t& t : taken) t = in.readBool();
}

void MujocoWorld::resume(const Saved& saved, const State& state) {
  const std::ptrdiff_t numbers = m_->nq + 3 * std::ptrdiff_t{m_->nv} + m_->na;
  if (std::ssize(saved.numbers) != numbers || saved.taken.size() != trees_.links.size() ||
      state.loaded.size() != state.bodies.size())
    throw Error(fmt::format("expected the saved state of {} coordinates and {} bodies, found {} numbers and {} bodies",
                            m_->nq, trees_.links.size(), saved.numbers.size(), saved.taken.size()));
  auto from = saved.numbers.begin();
  forEachNumber([&from](mjtNum& v) { v = *from++; });
  for (Index i = 0; i < trees_.links.size(); ++i)
    taken_[i] = saved.taken[i] && trees_.links[i].body != kNone ? state.loaded[trees_.links[i].body] : 0;
  prepared_ = false;
}

}  // namespace spark::mujoco
