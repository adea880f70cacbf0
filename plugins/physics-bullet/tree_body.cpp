#include "tree_body.h"

#include <Eigen/Eigenvalues>

// Bullet's links have their origin in the centre of mass and their axes along the principal axes of inertia. A joint of
// several axes is a chain of links without mass, and the body at its end. Coordinates are those of body a of the joint
// relative to b: where the child is body b, the axes point the other way.

namespace spark::bullet {

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

/// The gyroscopic torque on a body, world frame, that turns its spin as Euler's equations do in a whole step. The
/// torque at the begin of the step, which Bullet would take, gains energy until a body that tumbles at 12 rad/s in
/// steps of 20 ms bursts.
Vec3 gyroscopicTorque(const engine::Body& body, const DynamicState& s, double dt) {
  const Vec3 start = s.rotation.transpose() * s.angularVelocity;
  const auto rate = [&](const Vec3& w) { return Vec3(body.inverseInertia * (body.inertia * w).cross(w)); };
  if (rate(start).isZero(0) || !start.allFinite()) return Vec3::Zero();
  // Runge-Kutta of order 4, in parts of about a quarter of a radian.
  const double parts = std::clamp(std::ceil(4 * dt * start.norm()), 1.0, 20.0), h = dt / parts;
  Vec3 w = start;
  for (int i = 0; i < static_cast<int>(parts); ++i) {
    const Vec3 a = rate(w), b = rate(w + h / 2 * a), c = rate(w + h / 2 * b), d = rate(w + h * c);
    w += h / 6 * (a + 2 * b + 2 * c + d);
  }
  // It keeps its energy.
  const double before = start.dot(body.inertia * start), after = w.dot(body.inertia * w);
  if (!(after <= before)) w = after < HUGE_VAL ? Vec3(w * std::sqrt(before / after)) : start;
  return s.rotation * (body.inertia * (w - start)) / dt;
}

/// One of Bullet's joints in the chain that a joint becomes.
struct Step {
  int axis;  ///< see Dof
  bool slides;
  bool inA;  ///< the axis is fixed in body a
};

/// From b to a.
std::vector<Step> chainOf(JointType type) {
  switch (type) {
    case JointType::hinge:
      return {{0, false, true}};
    case JointType::slider:
      return {{0, true, true}};
    case JointType::universal:
      return {{1, false, false}, {0, false, true}};
    case JointType::hinge2:
      return {{1, false, false}, {0, false, true}, {-1, true, true}};
    default:
      return {};
  }
}

int bulletLinksOf(JointType type) { return std::max(1, static_cast<int>(chainOf(type).size())); }

}  // namespace

TreeBody::TreeBody(const Model& model, Tree tree) : tree_(std::move(tree)), places_(tree_.links.size()) {
  for (Index i = 0; i < places_.size(); ++i) {
    const Mat3& inertia = model.bodies[tree_.links[i].body].inertia;
    Place& p = places_[i];
    p.moments = inertia.diagonal();
    if (inertia.isDiagonal(1e-14)) continue;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
    Mat3 axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) *= -1;
    p.moments = solver.eigenvalues();
    p.axes = Eigen::Quaterniond(axes);
    p.turned = true;
  }
  build(model);
}

void TreeBody::build(const Model& model) {
  const Link& root = tree_.links.front();
  const bool isFree = root.joint == kNone;
  int links = 0;
  for (const Link& link : tree_.links)
    if (link.joint != kNone) links += bulletLinksOf(model.joints[link.joint].type);
  // A tree that is joined to the world has a base that does not move.
  const double mass = isFree ? model.bodies[root.body].mass : 0;
  const Vec3 moments = isFree ? places_[0].moments : Vec3(Vec3::Zero());
  body_ = std::make_unique<btMultiBody>(links, mass, toBullet(moments), !isFree, false);
  int next = 0;
  for (Index i = 0; i < tree_.links.size(); ++i) {
    const int first = static_cast<int>(dofs_.size());
    if (tree_.links[i].joint != kNone) addLink(model, i, next);
    dofsOf_.emplace_back(first, static_cast<int>(dofs_.size()));
  }
  body_->finalizeMultiDof();
  body_->setLinearDamping(0);
  body_->setAngularDamping(0);
  body_->setMaxCoordinateVelocity(HUGE_VAL);
  body_->setCanSleep(false);
  body_->setUseGyroTerm(false);
}

void TreeBody::addLink(const Model& model, Index index, int& next) {
  const Link& link = tree_.links[index];
  const Joint& j = model.joints[link.joint];
  Place& place = places_[index];
  const Eigen::Quaterniond parentAxes =
      link.parent == kNone ? Eigen::Quaterniond::Identity() : places_[link.parent].axes;
  const int parent = link.parent == kNone ? -1 : places_[link.parent].link;
  const double mass = model.bodies[link.body].mass;
  const btVector3 moments = toBullet(place.moments), none(0, 0, 0);
  // Where the joint is, in the child, and from the parent's centre.
  const bool central = j.type == JointType::slider || j.type == JointType::fixed;
  const Vec3 pivot = central ? Vec3(Vec3::Zero()) : link.childIsA ? j.inA.anchor : j.inB.anchor;
  const btVector3 toPivot = toBullet(parentAxes.conjugate() * (link.zero.position + link.zero.rotation * pivot));
  const btVector3 toCentre = toBullet(place.axes.conjugate() * Vec3(-pivot));
  const Eigen::Quaterniond zero(link.zero.rotation);
  const btQuaternion toChild = toBullet((parentAxes.conjugate() * zero * place.axes).conjugate().normalized());

  std::vector<Step> chain = chainOf(j.type);
  if (!link.childIsA) std::reverse(chain.begin(), chain.end());
  if (chain.empty()) {
    place.link = next++;
    if (j.type == JointType::ball) {
      place.ball = place.link;
      body_->setupSpherical(place.link, mass, moments, parent, toChild, toPivot, toCentre, true);
    } else {
      body_->setupFixed(place.link, mass, moments, parent, toChild, toPivot, toCentre);
    }
    return;
  }
  const double sign = (link.childIsA ? 1 : -1) * (j.type == JointType::slider && j.reversed ? -1 : 1);
  bool turned = false;
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const Step& s = chain[k];
    const bool first = k == 0, last = k + 1 == chain.size();
    const Vec3 own = s.inA ? j.inA.axis[0] : j.inB.axis[1];
    const Vec3 inChild = s.inA == link.childIsA ? own : Vec3(link.zero.rotation.transpose() * own);
    const Vec3 direction = sign * inChild;
    const btVector3 axis = toBullet(place.axes.conjugate() * direction);
    const int at = next++;
    const auto set = [&](auto setup) {
      (body_.get()->*setup)(at, last ? mass : 0, last ? moments : none, first ? parent : at - 1,
                            first ? toChild : btQuaternion::getIdentity(), axis, first ? toPivot : none,
                            last ? toCentre : none, true);
    };
    set(s.slides ? &btMultiBody::setupPrismatic : &btMultiBody::setupRevolute);
    dofs_.push_back({link.joint, s.axis, at, s.slides, direction, !s.slides && !turned && chain.size() > 1});
    turned |= !s.slides;
    place.link = at;
  }
}

// ---- state ----

void TreeBody::take(const Model& model, const State& state) {
  const Link& root = tree_.links.front();
  // A base that does not move is in its place also after a step that gave no numbers.
  root.joint == kNone ? takeRoot(state.bodies[root.body], places_[0]) : takeRoot(worldState(), {});
  for (Index i = 0; i < tree_.links.size(); ++i)
    if (tree_.links[i].joint != kNone) takeLink(model, state, i);
}

void TreeBody::takeRoot(const DynamicState& s, const Place& place) {
  const Eigen::Quaterniond own(s.quaternion[0], s.quaternion[1], s.quaternion[2], s.quaternion[3]);
  body_->setBasePos(toBullet(s.position));
  body_->setWorldToBaseRot(toBullet((place.turned ? own * place.axes : own).conjugate()));
  body_->setBaseVel(toBullet(s.linearVelocity));
  body_->setBaseOmega(toBullet(s.angularVelocity));
}

void TreeBody::takeLink(const Model& model, const State& state, Index index) {
  const Link& link = tree_.links[index];
  const Place& place = places_[index];
  for (int i = dofsOf_[index].first; i < dofsOf_[index].second; ++i) {
    Dof& dof = dofs_[static_cast<std::size_t>(i)];
    takeDof(dof, model, state, link);
    // The stops of a wheel's second axis would count the other way; it has none.
    const bool opposite = model.joints[dof.joint].type == JointType::hinge2 && dof.axis == 1;
    body_->setJointPos(dof.link, opposite ? -dof.position : dof.position);
    body_->setJointVel(dof.link, dof.rate);
  }
  if (place.ball < 0) return;
  const DynamicState& child = state.bodies[link.body];
  const DynamicState& parent = link.parent == kNone ? worldState() : state.bodies[tree_.links[link.parent].body];
  const Mat3 delta = link.zero.rotation.transpose() * parent.rotation.transpose() * child.rotation;
  const Eigen::Quaterniond q = (place.axes.conjugate() * Eigen::Quaterniond(delta) * place.axes).normalized();
  const Vec3 spin =
      place.axes.conjugate() * Vec3(child.rotation.transpose() * (child.angularVelocity - parent.angularVelocity));
  const double position[] = {q.x(), q.y(), q.z(), q.w()};
  body_->setJointPosMultiDof(place.ball, position);
  body_->setJointVelMultiDof(place.ball, spin.data());
}

void TreeBody::takeDof(Dof& dof, const Model& model, const State& state, const Link& link) {
  const Joint& j = model.joints[dof.joint];
  const DynamicState& child = state.bodies[link.body];
  const DynamicState& parent = link.parent == kNone ? worldState() : state.bodies[tree_.links[link.parent].body];
  if (!dof.slides) {
    // Turns are counted by the physics server.
    dof.position = state.coordinates[dof.joint].at(static_cast<std::size_t>(dof.axis));
    const Vec3 axis =
        dof.atParent ? parent.rotation * (link.zero.rotation * dof.direction) : Vec3(child.rotation * dof.direction);
    dof.rate = axis.dot(child.angularVelocity - parent.angularVelocity);
    return;
  }
  // From where the parent holds the anchor to where the child has it, along the joint's axis 1.
  const bool slider = j.type == JointType::slider;
  const double sign = slider && j.reversed ? -1 : 1;
  const DynamicState &a = link.childIsA ? child : parent, &b = link.childIsA ? parent : child;
  const Vec3 axis = sign * (a.rotation * j.inA.axis[0]);
  const Vec3 armA = slider ? Vec3(Vec3::Zero()) : Vec3(a.rotation * j.inA.anchor), armB = b.rotation * j.inB.anchor;
  const Vec3 apart = a.position + armA - b.position - armB;
  const Vec3 velocity =
      a.linearVelocity + a.angularVelocity.cross(armA) - b.linearVelocity - b.angularVelocity.cross(armB);
  // The axis turns with body a.
  dof.position = axis.dot(apart);
  dof.rate = axis.dot(velocity) + a.angularVelocity.cross(axis).dot(apart);
}

void TreeBody::accelerate(const Model& model, const State& state, double dt, Scratch& scratch) {
  body_->clearForcesAndTorques();
  for (Index i = 0; i < tree_.links.size(); ++i) {
    const Index index = tree_.links[i].body;
    const engine::Body& b = model.bodies[index];
    Vec3 force = state.bodies[index].force;
    if (b.gravity) force += b.mass * model.parameters.gravity;
    const Vec3 torque = state.bodies[index].torque + gyroscopicTorque(b, state.bodies[index], dt);
    const btVector3 f = toBullet(force), t = toBullet(torque);
    if (const int link = places_[i].link; link < 0)
      body_->addBaseForce(f), body_->addBaseTorque(t);
    else
      body_->addLinkForce(link, f), body_->addLinkTorque(link, t);
  }
  body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(dt, scratch.scalars, scratch.vectors, scratch.matrices,
                                                              false, false, false);
  body_->clearForcesAndTorques();
}

void TreeBody::move(State& state, double dt, Scratch& scratch) {
  body_->processDeltaVeeMultiDof2();
  body_->stepPositionsMultiDof(dt);
  body_->forwardKinematics(scratch.rotations, scratch.origins);
  scratch.omegas.resizeNoInitialize(body_->getNumLinks() + 1);
  scratch.velocities.resizeNoInitialize(body_->getNumLinks() + 1);
  body_->compTreeLinkVelocities(&scratch.omegas[0], &scratch.velocities[0]);
  for (Index i = 0; i < tree_.links.size(); ++i) give(state, i, scratch);
  for (Dof& dof : dofs_) {
    dof.rate = body_->getJointVel(dof.link);
    dof.position += dof.rate * dt;
  }
}

void TreeBody::clearForces(State& state) const {
  for (const Link& link : tree_.links) {
    state.bodies[link.body].force.setZero();
    state.bodies[link.body].torque.setZero();
  }
}

void TreeBody::give(State& state, Index index, Scratch& scratch) const {
  const Place& place = places_[index];
  const int at = place.link + 1;
  DynamicState& s = state.bodies[tree_.links[index].body];
  const Eigen::Quaterniond axes = toEigen(scratch.rotations[at]).conjugate().normalized();
  const Eigen::Quaterniond q = place.turned ? (axes * place.axes.conjugate()).normalized() : axes;
  s.quaternion = {q.w(), q.x(), q.y(), q.z()};
  s.rotation = rotationOf(s.quaternion);
  s.position = toVec(scratch.origins[at]);
  s.angularVelocity = axes * toVec(scratch.omegas[at]);
  s.linearVelocity = axes * toVec(scratch.velocities[at]);
  s.awake = true;
  ++s.version;
  state.markMoved(tree_.links[index].body);
}

}  // namespace spark::bullet
