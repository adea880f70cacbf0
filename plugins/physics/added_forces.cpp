#include "added_forces.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "joint_frames.h"

namespace spark::physics {

using engine::axesOf;
using engine::AxisLaw;
using engine::DynamicState;
using engine::Index;
using engine::Joint;
using engine::JointAxis;
using engine::JointType;
using engine::kNone;

namespace {

/// The matrix of v -> arm x v.
Mat3 crossMatrix(const Vec3& arm) {
  return (Mat3() << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0).finished();
}

/// The axis as stops count the coordinate: a reversed universal joint has them exchanged.
int axisOfStops(const Joint& j, int axis) { return j.type == JointType::universal && j.reversed ? 1 - axis : axis; }

}  // namespace

void AddedForces::look() {
  const std::pair now{world_.model.structure, world_.model.dynamics};
  if (std::exchange(lookedAt_, now) == now) return;
  passive_.clear();
  for (Index i = 0; i < world_.model.joints.size(); ++i) {
    const Joint& j = world_.model.joints[i];
    const auto isPassive = [&](int axis) {
      const JointAxis& a = j.axes[axis];
      return a.damping > 0 || a.stiffness > 0 || a.armature > 0;
    };
    if (!attached(j)) continue;
    if (j.type == JointType::ball && j.axes[0].damping > 0) passive_.push_back({i, 0});
    for (int axis = 0; axis < axesOf(j.type); ++axis)
      if (isPassive(axis)) passive_.push_back({i, axis});
  }
  bodiesDamped_ = false;
  for (const engine::Body& b : world_.model.bodies) bodiesDamped_ |= b.linearDamping > 0 || b.angularDamping > 0;
}

void AddedForces::add(const engine::Capabilities& can, double dt) {
  look();
  world_.state.laws.clear();
  addPassive(can, dt);
  if (!can.controls) addControls(dt);
  if (!can.laws) applyLaws(dt);
  if (!can.bodyDamping && bodiesDamped_) addBodyDamping(dt);
}

bool AddedForces::acts(const Joint& j) const {
  return attached(j) && (world_.state.bodies[j.a].awake || (j.b != kNone && world_.state.bodies[j.b].awake));
}

void AddedForces::addControls(double dt) {
  for (const engine::AxisControl& c : world_.state.controls) {
    if (!acts(world_.model.joints[c.joint])) continue;
    const engine::Control& own = c.control;
    const AxisLaw law = lawOf(c.joint, c.axis);
    const double angle = own.stiffness > 0 || own.termCount > 0 ? joints_.angle(c.joint, c.axis) : 0;
    const double spring = own.stiffness > 0 ? own.stiffness * (own.position - angle) : 0;
    Terms terms{.force = spring + own.damping * own.velocity + own.force,
                .damping = own.damping,
                .stiffness = own.stiffness,
                .maxForce = own.maxForce};
    for (int i = 0; i < own.termCount; ++i) addTerm(own.terms[static_cast<std::size_t>(i)], angle, law, dt, terms);
    addLaw(law, terms, dt);
  }
}

void AddedForces::addTerm(const engine::ControlTerm& term, double angle, const AxisLaw& law, double dt,
                          Terms& to) const {
  const double rate = term.damping == 0 ? 0 : rateAlong(law);
  // What drives instead of damping is a force of the present velocity.
  const double damping = std::max(term.damping, 0.0);
  const double force = term.force - term.stiffness * angle - (term.damping - damping) * rate;
  const double present = force - damping * rate, bounded = std::max(term.least, std::min(term.most, present));
  double share = 1;  // of the law that acts
  if (bounded != present) {
    const double implicit = damping > 0 ? present / (1 + damping * dt * mobility(law)) : present;
    share = implicit == std::max(term.least, std::min(term.most, implicit)) ? bounded / present : 0;
    if (share <= 0) return void(to.force += bounded);
  }
  to.force += share * force;
  to.damping += share * damping;
  to.stiffness += share * std::max(term.stiffness, 0.0);
}

void AddedForces::addPassive(const engine::Capabilities& can, double dt) {
  if (can.springs && can.damping) return;
  for (const auto& [joint, axis] : passive_) {
    const Joint& j = world_.model.joints[joint];
    const JointAxis& a = j.axes[axis];
    if (!acts(j)) continue;
    if (j.type == JointType::ball) {
      if (!can.damping) addBall(joint);
      continue;
    }
    Terms terms;
    if (!can.springs && a.stiffness > 0) {
      terms.stiffness = a.stiffness;
      terms.force = a.stiffness * (a.springPosition - joints_.angle(joint, axis));
    }
    if (!can.damping) {
      terms.damping = a.damping;
      // A force of the present motion alone is no inertia.
      if (can.laws) terms.armature = a.armature;
    }
    if (terms.stiffness > 0 || terms.damping > 0 || terms.armature > 0) addLaw(lawOf(joint, axis), terms, dt);
  }
}

void AddedForces::addBall(Index joint) {
  for (int i = 0; i < 3; ++i)
    world_.state.laws.push_back(
        {.joint = joint, .axis = i, .along = Vec3::Unit(i), .resistance = world_.model.joints[joint].axes[0].damping});
}

AxisLaw AddedForces::lawOf(Index joint, int axis) const {
  const Joint& j = world_.model.joints[joint];
  return {.joint = joint, .axis = axisOfStops(j, axis), .along = angleSign(j, axis) * joints_.worldAxis(j, axis)};
}

void AddedForces::addLaw(AxisLaw law, const Terms& terms, double dt) {
  law.force = terms.force;
  law.resistance = terms.damping;
  law.maxForce = terms.maxForce;
  if (terms.armature > 0) {
    law.resistance += terms.armature / dt;
    law.force += terms.armature * (rateAlong(law) / dt - driftAlong(law));
  }
  if (terms.stiffness > 0) {
    const double w = mobility(law), stiff = terms.stiffness * dt * dt * w / (1 + law.resistance * dt * w);
    if (stiff > 1) law.resistance += (1 - 1 / stiff) * terms.stiffness * dt;
  }
  // A force that no velocity changes needs no law.
  law.resistance > 0 ? world_.state.laws.push_back(law) : apply(law, law.force);
}

double AddedForces::mobility(const AxisLaw& law) const {
  const Joint& j = world_.model.joints[law.joint];
  const bool slides = j.type == JointType::slider, pinned = hasAnchor(j.type) && j.type != JointType::hinge2;
  const Vec3 torque = slides ? sliderArm(j).cross(law.along) : law.along;
  double sum = 0;
  Mat3 ofAnchor = Mat3::Zero();  // mobility of the anchor point
  Vec3 shift = Vec3::Zero();     // how it would come apart
  for (const Index i : {j.a, j.b}) {
    if (i == kNone) continue;
    const engine::Body& body = world_.model.bodies[i];
    const Mat3& r = world_.state.bodies[i].rotation;
    const Mat3 inverseInertia = r * body.inverseInertia * r.transpose();
    const Vec3 turned = inverseInertia * torque;
    sum += torque.dot(turned) + (slides ? 1 / body.mass : 0);
    if (!pinned) continue;
    const Vec3 arm = r * (i == j.a ? j.inA : j.inB).anchor;
    const Mat3 cross = crossMatrix(arm);
    ofAnchor += Mat3(Mat3::Identity() / body.mass) - cross * inverseInertia * cross;
    shift += turned.cross(arm);
  }
  return pinned ? std::max(sum - shift.dot(ofAnchor.ldlt().solve(shift)), 0.0) : sum;
}

Vec3 AddedForces::sliderArm(const Joint& j) const {
  const DynamicState* b = world_.stateAt(j.b);
  return b ? Vec3(0.5 * (b->position - world_.state.bodies[j.a].position)) : Vec3(Vec3::Zero());
}

double AddedForces::rateAlong(const AxisLaw& law) const {
  const Joint& j = world_.model.joints[law.joint];
  const DynamicState &a = world_.state.bodies[j.a], *b = world_.stateAt(j.b);
  if (j.type != JointType::slider) return law.along.dot(a.angularVelocity - angularVelocity(b));
  const Vec3 turning = a.angularVelocity + angularVelocity(b), linearB = b ? b->linearVelocity : Vec3(Vec3::Zero());
  return law.along.dot(a.linearVelocity - linearB) + sliderArm(j).cross(law.along).dot(turning);
}

double AddedForces::driftAlong(const AxisLaw& law) const {
  const Joint& j = world_.model.joints[law.joint];
  const DynamicState &a = world_.state.bodies[j.a], *b = world_.stateAt(j.b);
  if (j.type != JointType::slider || !b) return 0;
  const Vec3 turning = a.angularVelocity.cross(law.along);
  return 2 * turning.dot(a.linearVelocity - b->linearVelocity) +
         a.angularVelocity.cross(turning).dot(a.position - b->position);
}

void AddedForces::applyLaws(double dt) {
  // As if no other joint held the bodies: less than the law says where it is stiff for them, and never too much.
  for (const AxisLaw& law : world_.state.laws)
    apply(law, (law.force - law.resistance * rateAlong(law)) / (1 + law.resistance * dt * mobility(law)));
}

void AddedForces::apply(const AxisLaw& law, double force) {
  const Joint& j = world_.model.joints[law.joint];
  const Vec3 along = std::clamp(force, -law.maxForce, law.maxForce) * law.along;
  DynamicState& a = world_.state.bodies[j.a];
  DynamicState* b = j.b == kNone ? nullptr : &world_.state.bodies[j.b];
  if (j.type != JointType::slider) {
    a.torque += along;
    if (b) b->torque -= along;
    return;
  }
  const Vec3 torque = sliderArm(j).cross(along);
  a.force += along;
  a.torque += torque;
  if (!b) return;
  b->force -= along;
  b->torque += torque;
}

void AddedForces::addBodyDamping(double dt) {
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  for (Index i = 0; i < world_.model.bodies.size(); ++i) {
    const engine::Body& b = world_.model.bodies[i];
    DynamicState& s = world_.state.bodies[i];
    if ((b.linearDamping == 0 && b.angularDamping == 0) || !s.awake) continue;
    const Vec3 arm = s.rotation * b.linkOrigin;
    Vec6 motion;
    motion << s.linearVelocity, s.angularVelocity;
    // The velocity at the origin of the link's frame is J times the motion.
    Eigen::Matrix<double, 3, 6> j;
    j << Mat3::Identity(), -crossMatrix(arm);
    Mat6 damping = b.linearDamping * j.transpose() * j;
    damping.diagonal().tail<3>().array() += b.angularDamping;
    // Implicit, as if no joint held it: it never turns the motion back, however strong it is. With joints, which hold
    // more than the body, as much of it as it is strong.
    const double least = 1 / b.inverseInertia.trace();  // at most the least moment of inertia
    const double strength = dt * std::max(b.linearDamping / b.mass, b.angularDamping / least);
    const double share = b.joints == 0 ? 1 : std::max(0.0, 1 - 1 / std::max(strength, 1.0));
    Mat6 mass = Mat6::Zero();
    mass.diagonal().head<3>().setConstant(b.mass);
    mass.bottomRightCorner<3, 3>() = s.rotation * b.inertia * s.rotation.transpose();
    if (share > 0) motion = (mass + share * dt * damping).ldlt().solve(mass * motion);
    const Vec6 force = -damping * motion;
    s.force += force.head<3>();
    s.torque += force.tail<3>();
  }
}

}  // namespace spark::physics
