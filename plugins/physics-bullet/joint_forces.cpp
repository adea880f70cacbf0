#include "joint_forces.h"

#include <algorithm>

namespace spark::bullet {

using engine::DynamicState;

namespace {

Vec3 angularMomentumOf(const engine::Body& body, const DynamicState& s) {
  return s.rotation * (body.inertia * (s.rotation.transpose() * s.angularVelocity));
}

}  // namespace

bool JointForces::measures(const engine::Model& model, const std::vector<Link>& links) {
  return std::any_of(links.begin(), links.end(),
                     [&](const Link& l) { return l.joint != kNone && model.joints[l.joint].wantsFeedback; });
}

void JointForces::begin(const engine::Step& step, const std::vector<Link>& links) {
  for (const Link& link : links) {
    const engine::Body& body = step.model.bodies[link.body];
    const DynamicState& s = step.state.bodies[link.body];
    balances_[link.body] = {s.position, body.mass * s.linearVelocity, angularMomentumOf(body, s), s.force, s.torque};
    if (body.gravity) balances_[link.body].force += body.mass * step.model.parameters.gravity;
  }
}

void JointForces::add(Index body, const Vec3& force, const Vec3& torque, const Vec3& point) {
  if (body == kNone) return;
  Balance& b = balances_[body];
  b.force += force;
  b.torque += torque + (point - b.position).cross(force);
}

void JointForces::end(engine::Step& step, const std::vector<Link>& links) {
  // From the leaves to the root.
  for (std::size_t i = links.size(); i-- > 0;) {
    const Link& link = links[i];
    if (link.joint == kNone) continue;
    const engine::Body& body = step.model.bodies[link.body];
    const DynamicState& s = step.state.bodies[link.body];
    const Balance& b = balances_[link.body];
    const Vec3 force = (body.mass * s.linearVelocity - b.momentum) / step.dt - b.force;
    const Vec3 torque = (angularMomentumOf(body, s) - b.angularMomentum) / step.dt - b.torque;
    engine::JointState& out = step.state.joints[link.joint];
    const bool wanted = step.model.joints[link.joint].wantsFeedback;
    if (link.parent == kNone) {
      if (wanted) out = {force, torque, Vec3::Zero(), Vec3::Zero()};
      continue;
    }
    // The joint acts on the parent at the same place.
    const Index parent = links[link.parent].body;
    add(parent, -force, -torque, b.position);
    if (!wanted) continue;
    const Vec3 reaction = -torque - (b.position - balances_[parent].position).cross(force);
    out = link.childIsA ? engine::JointState{force, torque, -force, reaction}
                        : engine::JointState{-force, reaction, force, torque};
  }
}

}  // namespace spark::bullet
