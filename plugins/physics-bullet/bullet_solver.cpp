#include "bullet_solver.h"

#include <algorithm>

#include "joint_rows.h"

// Bullet's multi-bodies accelerate (Featherstone's articulated-body algorithm), its projected Gauss-Seidel solves the
// rows of motors, stops, loops and contacts, and the multi-bodies move. Poses and velocities come from the state in
// each step, and there is no warm start: a world that is restored goes on as before.

namespace spark::bullet {

using engine::Contact;
using engine::DynamicState;

void BulletSolver::compile(const engine::Model& model, const engine::State&) {
  Trees trees(model);
  leftOver_ = std::move(trees.leftOver);
  trees_.clear();
  treeOf_.assign(model.bodies.size(), kNone);
  linkOf_.assign(model.bodies.size(), kNone);
  for (Tree& tree : trees.trees) {
    for (Index i = 0; i < tree.links.size(); ++i) {
      treeOf_[tree.links[i].body] = static_cast<Index>(trees_.size());
      linkOf_[tree.links[i].body] = i;
    }
    trees_.push_back(std::make_unique<TreeBody>(model, std::move(tree)));
  }
  engine::readSoftness(model, softness_);
  forces_.compile(model);
  measured_.clear();
  for (const auto& tree : trees_) measured_.push_back(JointForces::measures(model, tree->links()));
  anyMeasured_ = std::any_of(model.joints.begin(), model.joints.end(), [](const auto& j) { return j.wantsFeedback; });
}

Side BulletSolver::sideOf(Index body) {
  if (body == kNone) return {};
  TreeBody& tree = *trees_[treeOf_[body]];
  return {&tree.multiBody(), tree.linkOf(linkOf_[body])};
}

void BulletSolver::step(engine::Step& step) {
  laws_.list(step.state);
  islands_.find(step, trees_.size(), treeOf_, leftOver_);
  for (std::size_t i = 0; i < islands_.count(); ++i)
    if (islands_.isActive(i)) stepIsland(step, i);
}

/// The number of equal parts in which an island is stepped. Coriolis and centrifugal forces are those of the begin of a
/// step: in one in which links turn far, light ones at the end of a chain gain energy until they burst.
int BulletSolver::partsOf(const engine::Step& step, std::size_t island) const {
  constexpr double kFar = 0.25, kPart = 0.1;  // rad
  constexpr double kMost = 20;
  double fastest = 0;  // (rad/s)^2
  for (const Index i : islands_.trees(island)) {
    const std::vector<Link>& links = trees_[i]->links();
    if (links.size() < 2) continue;
    for (const Link& link : links)
      fastest = std::max(fastest, step.state.bodies[link.body].angularVelocity.squaredNorm());
  }
  const double turn = std::sqrt(fastest) * step.dt;
  return !(turn > kFar) ? 1 : static_cast<int>(std::min(std::ceil(turn / kPart), kMost));
}

void BulletSolver::stepIsland(engine::Step& step, std::size_t island) {
  island_ = island;
  fullStep_ = step.dt;
  for (const Index i : islands_.trees(island)) {
    if (anyMeasured_) forces_.begin(step, trees_[i]->links());
    trees_[i]->take(step.model, step.state);
  }
  const int parts = partsOf(step, island);
  engine::Step part = step;
  part.dt /= parts;
  for (int i = 0; i < parts; ++i) stepPart(part, i == 0);
  for (const Index i : islands_.trees(island)) {
    trees_[i]->clearForces(step.state);
    if (measured_[i]) forces_.end(step, trees_[i]->links());
  }
}

void BulletSolver::stepPart(engine::Step& part, bool first) {
  step_ = &part;
  contactRows_.clear();
  loopRows_.clear();
  for (const Index i : islands_.trees(island_)) {
    trees_[i]->accelerate(part.model, part.state, part.dt, scratch_);
    trees_[i]->multiBody().setCompanionId(-1);
  }
  rows_.solve(*this, {.dt = part.dt, .direct = direct_, .iterations = iterations_, .tolerance = tolerance_});
  readContactForces(part, first);
  if (anyMeasured_) readLoopForces(part, first);
  for (const Index i : islands_.trees(island_)) trees_[i]->move(part.state, part.dt, scratch_);
}

void BulletSolver::write(RowSolver& rows) {
  const engine::Step& step = *step_;
  const JointRows joints{step, softness_, laws_, rows};
  for (const Index i : islands_.trees(island_)) {
    TreeBody& tree = *trees_[i];
    for (const Dof& dof : tree.dofs()) joints.writeDof(tree, dof);
    for (const Link& link : tree.links()) {
      if (link.joint == kNone || step.model.joints[link.joint].type != engine::JointType::ball) continue;
      const engine::Joint& j = step.model.joints[link.joint];
      joints.writeBallDamping(link.joint, sideOf(j.a), sideOf(j.b));
    }
  }
  for (const Index i : islands_.joints(island_)) {
    const engine::Joint& j = step.model.joints[leftOver_[i]];
    const int first = rows.rows();
    joints.writeJoint(leftOver_[i], sideOf(j.a), sideOf(j.b));
    loopRows_.push_back({leftOver_[i], first, rows.rows()});
  }
  for (const Index i : islands_.contacts(island_)) writeContact(rows, i);
}

void BulletSolver::writeContact(RowSolver& rows, Index index) {
  const Contact& c = step_->contacts[index];
  const engine::WorldParameters& world = step_->model.parameters;
  const engine::Surface& s = c.surface;
  const double dt = step_->dt;
  Row row{.a = sideOf(c.bodyA), .b = sideOf(c.bodyB)};
  row.pointA = row.pointB = c.position;
  // Along the normal: what is beyond the allowed depth is pushed out.
  const double excess = std::max(0.0, c.depth - world.contactSurfaceLayer);
  row.linear = c.normal;
  // The depth is that of the begin of the whole step.
  row.target = (s.softErpOn ? s.softErp : world.erp) * excess / fullStep_;
  row.softness = (s.softCfmOn ? s.softCfm : world.cfm) / dt;
  row.low = 0;
  if (s.bounceOn) {
    const auto speedOf = [&](Index body) {
      if (body == kNone) return 0.0;
      const DynamicState& b = step_->state.bodies[body];
      return c.normal.dot(b.linearVelocity + b.angularVelocity.cross(c.position - b.position));
    };
    const double approach = speedOf(c.bodyB) - speedOf(c.bodyA);
    if (approach > s.bounceVelocity) row.target = std::max(row.target, s.bounce * approach);
  }
  ContactRows& own = contactRows_.emplace_back();
  own.contact = index;
  own.normal = rows.addNormal(row);
  if (s.mu <= 0) return;
  // Across it: friction.
  own.bounded = !s.pyramid && std::isfinite(s.mu);
  perpendicularBasis(c.normal, own.tangents[0], own.tangents[1]);
  row.target = 0;
  for (const std::size_t i : {0, 1}) {
    row.linear = own.tangents[i];
    row.softness = (s.slipOn ? (i == 0 ? s.slip1 : s.slip2) : world.cfm) / dt;
    row.low = own.bounded ? -s.mu * dt : -HUGE_VAL;
    row.high = -row.low;
    own.friction[i] = own.bounded ? rows.addRow(row) : rows.addFriction(row, own.normal, s.mu);
  }
}

void BulletSolver::readLoopForces(engine::Step& step, bool first) {
  for (const LoopRows& loop : loopRows_) {
    const engine::Joint& j = step.model.joints[loop.joint];
    engine::JointState sum;
    if (!first) sum = step.state.joints[loop.joint];
    const auto add = [&](Index body, const Vec3& force, const Vec3& torque, const Vec3& point, Vec3& f, Vec3& t) {
      if (body == kNone) return;
      forces_.add(body, force, torque, point);
      f += force, t += torque + (point - step.state.bodies[body].position).cross(force);
    };
    for (int i = loop.first; i < loop.last; ++i) {
      const Row& row = rows_.row(i);
      const double strength = rows_.impulseOfRow(i) / fullStep_;
      const Vec3 force = strength * row.linear, torque = strength * row.angular;
      add(j.a, force, torque, row.pointA, sum.forceA, sum.torqueA);
      add(j.b, -force, -torque, row.pointB, sum.forceB, sum.torqueB);
    }
    if (j.wantsFeedback) step.state.joints[loop.joint] = sum;
  }
}

void BulletSolver::readContactForces(engine::Step& step, bool first) {
  for (const ContactRows& r : contactRows_) {
    Contact& c = step.contacts[r.contact];
    if (!c.feedback && !anyMeasured_) continue;
    Vec3 impulse = rows_.impulseOfNormal(r.normal) * c.normal;
    for (const std::size_t i : {0, 1})
      if (r.friction[i] >= 0)
        impulse +=
            (r.bounded ? rows_.impulseOfRow(r.friction[i]) : rows_.impulseOfFriction(r.friction[i])) * r.tangents[i];
    const Vec3 force = impulse / fullStep_;
    if (c.feedback) c.forceOnA = first ? force : Vec3(c.forceOnA + force);
    if (!anyMeasured_) continue;
    forces_.add(c.bodyA, force, Vec3::Zero(), c.position);
    forces_.add(c.bodyB, -force, Vec3::Zero(), c.position);
  }
}

}  // namespace spark::bullet
