#include "island.h"

#include "motion.h"

namespace spark::articulated {

namespace {

/// Rows stiffer than this, against how their bodies give, would drown the inertia of which they became a part.
constexpr double kStiffest = 1e8;
/// Rows of the dense system are this soft at least, against how their bodies give: rows that say the same twice share
/// their force then, and velocities change less than rounding would.
constexpr double kLeastSoftness = 1e-11;
/// Velocities that differ by less [m/s, rad/s; or this part of the island's velocities] are the same to the pivoting.
constexpr double kSameVelocity = 1e-11;

Vec3 vec(const double* v) { return {v[0], v[1], v[2]}; }

Mat3 matrix(const double* r) {
  Mat3 m;
  m << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return m;
}

}  // namespace

void Island::reserve(std::size_t bodies, std::size_t rows, std::size_t coupling, std::size_t depth) {
  system_.trees.begin(bodies);
  system_.rows.reserve(rows + kJointRows);
  system_.coupling.reserve(coupling, 2 * depth);
  pivoting_.reserve(rows);
  joints_.reserve(rows);
  contacts_.reserve(rows);
}

int Island::nodeOf(const WorldView& world, const engine::SolverBody* body) const {
  if (!body) return -1;
  const auto tree = static_cast<std::size_t>(world.topology.treeOf[body->index]);
  return world.firstNode[tree] + world.topology.branchOf[body->index] - world.topology.trees[tree].start;
}

void Island::readBodies(WorldView& world, const IslandPlan& plan) {
  system_.trees.begin(plan.bodies);
  int next = 0;
  double fastest = 1;
  for (const int t : plan.trees) {
    const Tree& tree = world.topology.trees[static_cast<std::size_t>(t)];
    const int shift = next - tree.start;
    world.firstNode[static_cast<std::size_t>(t)] = next;
    for (int i = tree.start; i < tree.end; ++i, ++next) {
      const Branch& branch = world.topology.branches[static_cast<std::size_t>(i)];
      Node& n = node(next);
      engine::SolverBody& body = *world.step.bodies[static_cast<std::size_t>(branch.body)];
      n.body = &body;
      n.parent = branch.parent < 0 ? -1 : branch.parent + shift;
      n.joint = branch.joint;
      n.rowCount = 0;
      n.groundRow = -1;
      n.changed = true;
      n.held = false;
      Frame& f = n.frame;
      f.position = vec(body.position), f.velocity = vec(body.linearVelocity), f.spin = vec(body.angularVelocity);
      f.rotation = matrix(body.rotation);
      f.turn = Turn::of(body.quaternion);
      f.force = vec(body.force), f.torque = vec(body.torque);
    }
  }
  // Apart from gathering, which waits for memory: many bodies at a time.
  for (Node& n : system_.trees.nodes) {
    const engine::SolverBody& body = *n.body;
    Frame& f = n.frame;
    n.inertia.noalias() = f.rotation * body.inertia * f.rotation.transpose();
    if (body.gravity) f.force += body.mass * world.step.parameters.gravity;
    if (body.gyroscopic) f.torque += gyroscopicTorque(n.inertia, f.spin, world.step.dt);
    fastest = std::max({fastest, f.velocity.cwiseAbs().maxCoeff(), f.spin.cwiseAbs().maxCoeff()});
  }
  slack_ = kSameVelocity * fastest * scale_.perSecond;
}

Island::Part Island::addJoint(WorldView& world, int index) {
  const engine::SolverJoint& joint = *world.step.joints[static_cast<std::size_t>(index)];
  const int a = nodeOf(world, joint.a), b = nodeOf(world, joint.b);
  Rows& rows = system_.rows;
  Part part{index, rows.size(), 0};
  part.count = jointRows(joint, node(a).frame, b < 0 ? nullptr : &node(b).frame, scale_, rows.offer(kJointRows));
  rows.take(part.count);
  const JointMemory& memory = world.memory[static_cast<std::size_t>(index)];
  for (int i = part.first; i < part.first + part.count; ++i) {
    Row& row = rows[i];
    row.nodeA = a, row.nodeB = b;
    if (!row.bounded()) continue;
    const auto axis = static_cast<std::size_t>(row.axis);
    if (memory.stop[axis] == row.stop) row.state = memory.state[axis];
    // A stop's open side has no bound to stand at.
    if (std::isinf(row.bound())) row.state = State::holds;
    bound(i);
  }
  joints_.push_back(part);
  return part;
}

void Island::couple(int index) {
  Row& row = system_.rows[index];
  row.softness = std::max(row.softness, kLeastSoftness * mobility(row));
  system_.coupling.add(index);
}

void Island::readJoints(WorldView& world, const IslandPlan& plan) {
  for (Node& n : system_.trees.nodes) {
    if (n.joint < 0) continue;
    const Part part = addJoint(world, n.joint);
    n.firstRow = part.first, n.rowCount = part.count;
  }
  for (const int t : plan.trees) {
    const Tree& tree = world.topology.trees[static_cast<std::size_t>(t)];
    for (int i = tree.extraStart; i < tree.extraEnd; ++i) {
      const Part part = addJoint(world, world.topology.extraJoints[static_cast<std::size_t>(i)]);
      for (int r = part.first; r < part.first + part.count; ++r) couple(r);
    }
  }
}

double Island::mobility(const Six& along, int index) const {
  const engine::SolverBody& body = *system_.trees.nodes[static_cast<std::size_t>(index)].body;
  const Vec3 turning =
      system_.trees.nodes[static_cast<std::size_t>(index)].frame.rotation.transpose() * along.angular();
  return along.linear().squaredNorm() / body.mass + turning.dot(body.inverseInertia * turning);
}

double Island::mobility(const Row& row) const {
  return mobility(row.a, row.nodeA) + (row.nodeB >= 0 ? mobility(row.b, row.nodeB) : 0);
}

/// The row has bounds that pivoting is to find.
void Island::bound(int index) {
  const Row& row = system_.rows[index];
  pivoting_.rows.push_back({index, slack_, slack_ / (mobility(row) + row.softness)});
}

void Island::joinBody(Row& row, int index) {
  Node& n = node(row.nodeA);
  row.inBody = true;
  row.next = n.groundRow;
  n.groundRow = index;
}

void Island::readContacts(WorldView& world, const IslandPlan& plan) {
  Rows& rows = system_.rows;
  for (const int c : plan.contacts) {
    const engine::Contact& contact = world.step.contacts[static_cast<std::size_t>(c)];
    const engine::SolverPair& pair = world.step.pairs[static_cast<std::size_t>(c)];
    const int a = nodeOf(world, pair.a), b = nodeOf(world, pair.b);
    Part part{c, rows.size(), 0};
    part.count = contactRows(contact, pair.reversed, node(a).frame, b < 0 ? nullptr : &node(b).frame, scale_,
                             rows.offer(kContactRows));
    rows.take(part.count);
    const ContactMemory::States* before = world.contacts.before(c);
    for (int i = part.first; i < part.first + part.count; ++i) {
      Row& row = rows[i];
      row.nodeA = a, row.nodeB = b;
      if (before) row.state = (*before)[static_cast<std::size_t>(i - part.first)];
      if (std::isinf(row.bound())) row.state = State::holds;
      if (b < 0 && row.softness * kStiffest > mobility(row.a, a))
        joinBody(row, i);
      else
        couple(i);
      if (row.frictionOf >= 0) {
        row.frictionOf += part.first;
        pyramid_.push_back(i);
      } else if (row.bounded()) {
        bound(i);
      }
    }
    contacts_.push_back(part);
  }
}

/// Momentum and forces, motors that press against stops included.
void Island::gatherForces() {
  for (Node& n : system_.trees.nodes) {
    const Frame& f = n.frame;
    n.given = Six::of(n.body->mass * scale_.perSecond * f.velocity + f.force,
                      n.inertia * (scale_.perSecond * f.spin) + f.torque);
  }
}

bool Island::settle() {
  for (const int i : pyramid_) system_.rows[i].state = State::off;
  if (!pivoting_.settle(system_)) return false;
  if (pyramid_.empty()) return true;
  // Friction of this kind is bounded by the normal forces without it.
  for (const int i : pyramid_) {
    Row& row = system_.rows[i];
    const double normal = std::abs(system_.rows[row.frictionOf].force);
    row.high = normal == 0 ? 0 : row.high * normal;
    row.low = -row.high;
    if (row.high == 0) continue;
    row.state = State::holds;
    system_.changed(row);
    if (row.bounded()) bound(i);
  }
  return pivoting_.settle(system_);
}

bool Island::step(WorldView& world, const IslandPlan& plan) {
  const engine::SolverStep& step = world.step;
  scale_ = {1 / step.dt, step.parameters.erp, step.parameters.cfm, step.parameters.contactSurfaceLayer};
  system_.rows.clear();
  system_.coupling.begin();
  pivoting_.rows.clear();
  joints_.clear();
  contacts_.clear();
  pyramid_.clear();
  readBodies(world, plan);
  readJoints(world, plan);
  readContacts(world, plan);
  if (system_.coupling.size() > static_cast<std::size_t>(step.maxCouplingRows)) return false;
  gatherForces();
  if (!settle()) return false;
  write(world);
  return true;
}

void Island::write(WorldView& world) {
  for (const Part& part : joints_) {
    JointMemory& memory = world.memory[static_cast<std::size_t>(part.index)];
    for (int i = part.first; i < part.first + part.count; ++i) {
      const Row& row = system_.rows[i];
      if (row.axis < 0) continue;
      memory.state[static_cast<std::size_t>(row.axis)] = row.state;
      memory.stop[static_cast<std::size_t>(row.axis)] = row.stop;
    }
  }
  for (const Part& part : contacts_)
    for (int i = 0; i < part.count; ++i)
      world.contacts.now(part.index)[static_cast<std::size_t>(i)] = system_.rows[part.first + i].state;
  for (Node& n : system_.trees.nodes) {
    const double dt = world.step.dt;
    integrate(*n.body, dt * n.motion.linear(), dt * n.motion.angular(), dt);
    n.body->awake = true;
  }
  writeFeedback(world);
}

void Island::writeFeedback(WorldView& world) const {
  const auto sum = [&](const Part& part, Six Row::*side) {
    Six out = Six::zero();
    for (int i = part.first; i < part.first + part.count; ++i) {
      const Row& row = system_.rows[i];
      out.add(row.*side, row.force);
    }
    return out;
  };
  for (const Part& part : joints_) {
    engine::SolverJoint& joint = *world.step.joints[static_cast<std::size_t>(part.index)];
    if (!joint.wantsFeedback) continue;
    const Six onA = sum(part, &Row::a), onB = joint.b ? sum(part, &Row::b) : Six::zero();
    joint.forceA = onA.linear(), joint.torqueA = onA.angular();
    joint.forceB = onB.linear(), joint.torqueB = onB.angular();
  }
  for (const Part& part : contacts_) {
    engine::Contact& contact = world.step.contacts[static_cast<std::size_t>(part.index)];
    if (!contact.feedback) continue;
    const Vec3 force = sum(part, &Row::a).linear();
    contact.forceOnA = world.step.pairs[static_cast<std::size_t>(part.index)].reversed ? Vec3(-force) : force;
  }
}

}  // namespace spark::articulated
