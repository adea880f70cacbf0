#include "island_solver.h"

#include <algorithm>

#include "integration.h"

namespace spark::articulated {

namespace {

/// Contact rows whose 1 / D exceeds the inverse of their mobility by this factor are not folded: the body's inertia
/// would be lost in rounding.
constexpr double kMaxFoldedStiffness = 1e8;
/// Lower bound of the D of coupling rows, as a fraction of their mobility. Redundant rows then share their force, and
/// velocities change by less than rounding does.
constexpr double kMinSoftness = 1e-11;
/// Velocities that differ by less count as equal in pivoting, relative to the island's largest velocity or to 1 m/s and
/// 1 rad/s if that is larger.
constexpr double kVelocityTolerance = 1e-11;

}  // namespace

void IslandSolver::reserve(std::size_t bodies, std::size_t rows, std::size_t couplingRows, std::size_t depth) {
  system_.trees.begin(bodies);
  system_.rows.reserve(rows + kMaxJointRows);
  // A row between two bodies has a path of up to `depth` nodes on each side.
  system_.coupling.reserve(couplingRows, 2 * depth);
  pivoting_.reserve(rows);
  joints_.reserve(rows);
  contacts_.reserve(rows);
}

void IslandSolver::clear() {
  system_.rows.clear();
  system_.coupling.begin();
  pivoting_.rows.clear();
  joints_.clear();
  contacts_.clear();
  pyramidRows_.clear();
}

/// A row cannot be at an infinite bound.
void IslandSolver::makeFinite(Row& row) {
  for (RowState* state : {&row.state, &row.frictionless})
    if ((*state == RowState::atLow && std::isinf(row.low)) || (*state == RowState::atHigh && std::isinf(row.high)))
      *state = RowState::holds;
}

/// The node of a body; kNone for the world.
Index IslandSolver::nodeOf(const WorldView& world, Index body) const {
  if (body == kNone) return kNone;
  const Index tree = world.topology.treeOf[body];
  return world.firstNode[tree] + world.topology.treeBodyOf[body] - world.topology.trees[tree].begin;
}

/// Fills the nodes, tree by tree: state, inertia in world axes, gravity and gyroscopic torque.
void IslandSolver::readBodies(WorldView& world, const IslandContents& island) {
  system_.trees.begin(island.bodies);
  Index next = 0;
  for (const Index t : island.trees) {
    const Tree& tree = world.topology.trees[t];
    const Index first = next;
    world.firstNode[t] = first;
    for (Index i = tree.begin; i < tree.end; ++i, ++next) {
      const TreeBody& treeBody = world.topology.treeBodies[i];
      engine::DynamicState& dynamic = world.step.state.bodies[treeBody.body];
      Node& n = node(next);
      n.body = &world.step.model.bodies[treeBody.body];
      n.dynamic = &dynamic;
      n.parent = treeBody.parent == kNone ? kNone : treeBody.parent - tree.begin + first;
      n.joint = treeBody.treeJoint;
      n.rowCount = 0;
      n.firstFolded = kNone;
      n.changed = true;
      n.connected = false;
      RigidBodyState& s = n.state;
      s.position = dynamic.position;
      s.linearVelocity = dynamic.linearVelocity, s.angularVelocity = dynamic.angularVelocity;
      s.rotation = dynamic.rotation;
      s.orientation = Quaternion::of(dynamic.quaternion);
      s.force = dynamic.force, s.torque = dynamic.torque;
    }
  }
  // In a separate loop: the one above only copies, so that the cache misses of many bodies overlap.
  double fastest = 1;
  for (Node& n : system_.trees.nodes) {
    const engine::Body& body = *n.body;
    RigidBodyState& s = n.state;
    n.worldInertia.noalias() = s.rotation * body.inertia * s.rotation.transpose();
    if (body.gravity) s.force += body.mass * world.step.model.parameters.gravity;
    s.torque += gyroscopicTorque(n.worldInertia, s.angularVelocity, world.step.dt);
    fastest = std::max({fastest, s.linearVelocity.cwiseAbs().maxCoeff(), s.angularVelocity.cwiseAbs().maxCoeff()});
  }
  motionTolerance_ = kVelocityTolerance * fastest * constants_.inverseDt;
}

/// Appends the rows of a joint, with the states of the last step.
IslandSolver::RowRange IslandSolver::addJoint(WorldView& world, Index index) {
  const engine::Joint& joint = world.step.model.joints[index];
  const Index a = nodeOf(world, joint.a), b = nodeOf(world, joint.b);
  Rows& rows = system_.rows;
  RowRange range{index, rows.size(), 0};
  range.count = writeJointRows(joint, world.softness[index], world.step.state.motors[index],
                               world.step.state.coordinates[index], world.laws, index, node(a).state,
                               b == kNone ? nullptr : &node(b).state, constants_, rows.prepare(kMaxJointRows));
  rows.commit(range.count);
  const JointWarmStart& last = world.joints[index];
  for (Index i = range.first; i < range.end(); ++i) {
    Row& row = rows[i];
    row.nodeA = a, row.nodeB = b;
    if (!row.bounded()) continue;
    if (last.stop[row.axis] == row.stop) {
      row.state = last.state[row.axis];
      row.frictionless = last.frictionless[row.axis];
    }
    makeFinite(row);
    addBounded(i);
  }
  joints_.push_back(range);
  return range;
}

/// The row becomes a coupling row.
void IslandSolver::addCoupling(Index index) {
  Row& row = system_.rows[index];
  row.softness = std::max(row.softness, kMinSoftness * freeMobility(row));
  system_.coupling.add(index);
}

void IslandSolver::readJoints(WorldView& world, const IslandContents& island) {
  // Tree joints, in order of the nodes.
  for (Node& n : system_.trees.nodes) {
    if (n.joint == kNone) continue;
    const RowRange range = addJoint(world, n.joint);
    n.firstRow = range.first, n.rowCount = range.count;
  }
  // Loop joints.
  for (const Index t : island.trees) {
    const Tree& tree = world.topology.trees[t];
    for (Index i = tree.loopBegin; i < tree.loopEnd; ++i) {
      const RowRange range = addJoint(world, world.topology.loopJoints[i]);
      for (Index r = range.first; r < range.end(); ++r) addCoupling(r);
    }
  }
}

/// J M^-1 J^T of one body.
double IslandSolver::freeMobility(const SpatialVector& jacobian, Index index) const {
  const Node& n = system_.trees.nodes[index];
  // The inverse inertia is in the body's frame.
  const Vec3 angular = n.state.rotation.transpose() * jacobian.angular();
  return jacobian.linear().squaredNorm() / n.body->mass + angular.dot(n.body->inverseInertia * angular);
}

/// Mobility (inverse effective mass) of a row if its bodies were free: J M^-1 J^T, without joints and contacts.
double IslandSolver::freeMobility(const Row& row) const {
  return freeMobility(row.jacobianA, row.nodeA) + (row.nodeB != kNone ? freeMobility(row.jacobianB, row.nodeB) : 0);
}

/// The row becomes one of those whose states pivoting finds.
void IslandSolver::addBounded(Index index) {
  const Row& row = system_.rows[index];
  pivoting_.rows.push_back({index, motionTolerance_, motionTolerance_ / (freeMobility(row) + row.softness)});
}

/// The row becomes part of body A's inertia and force.
void IslandSolver::fold(Index index) {
  Row& row = system_.rows[index];
  Node& n = node(row.nodeA);
  row.folded = true;
  row.nextFolded = n.firstFolded;
  n.firstFolded = index;
}

/// Appends the rows of all contacts, with the states of the last step.
void IslandSolver::readContacts(WorldView& world, const IslandContents& island) {
  Rows& rows = system_.rows;
  for (const Index c : island.contacts) {
    const engine::Contact& contact = world.step.contacts[c];
    const ContactBodies pair(contact);
    const Index a = nodeOf(world, pair.a), b = nodeOf(world, pair.b);
    RowRange range{c, rows.size(), 0};
    range.count = writeContactRows(contact, pair.reversed, node(a).state, b == kNone ? nullptr : &node(b).state,
                                   constants_, rows.prepare(kMaxContactRows));
    rows.commit(range.count);
    const ContactWarmStart::States* last = world.contacts.last(c);
    for (Index i = range.first; i < range.end(); ++i) {
      Row& row = rows[i];
      row.nodeA = a, row.nodeB = b;
      if (last) {
        row.state = last->rows[i - range.first];
        row.frictionless = last->frictionless;
      }
      if (row.normalRow == kNone) makeFinite(row);
      if (b == kNone && row.softness * kMaxFoldedStiffness > freeMobility(row.jacobianA, a))
        fold(i);
      else
        addCoupling(i);
      // The bounds of a friction pyramid are known only after a first solution.
      if (row.normalRow != kNone) {
        row.normalRow += range.first;
        pyramidRows_.push_back(i);
      } else if (row.bounded()) {
        addBounded(i);
      }
    }
    contacts_.push_back(range);
  }
}

/// M v / dt plus the forces of the step, with those of motors at stops.
void IslandSolver::setExternalForces() {
  for (Node& n : system_.trees.nodes) {
    const RigidBodyState& s = n.state;
    n.externalForce = SpatialVector::of(n.body->mass * constants_.inverseDt * s.linearVelocity + s.force,
                                        n.worldInertia * (constants_.inverseDt * s.angularVelocity) + s.torque);
  }
}

bool IslandSolver::solve() {
  if (pyramidRows_.empty()) return pivoting_.solve(system_);
  // A friction pyramid is bounded by mu times the normal force that acts without this friction (ODE's dContactApprox1):
  // solve without it first. Each of the two searches begins where its own one of the last step ended.
  const auto exchange = [&] {
    for (const BoundedRow& b : pivoting_.rows) {
      Row& row = system_.rows[b.row];
      if (row.state == row.frictionless) continue;
      std::swap(row.state, row.frictionless);
      system_.stateChanged(row);
    }
  };
  for (const Index i : pyramidRows_) {
    Row& row = system_.rows[i];
    row.frictionless = row.state;
    row.state = RowState::off;
  }
  exchange();
  if (!pivoting_.solve(system_)) return false;
  exchange();
  for (const Index i : pyramidRows_) {
    Row& row = system_.rows[i];
    const double normalForce = std::abs(system_.rows[row.normalRow].force);
    // The coefficient may be infinite, and infinity times 0 is NaN.
    row.high = normalForce == 0 ? 0 : row.high * normalForce;
    row.low = -row.high;
    if (row.high == 0) continue;
    row.state = row.frictionless == RowState::off ? RowState::holds : row.frictionless;
    makeFinite(row);
    system_.stateChanged(row);
    if (row.bounded()) addBounded(i);
  }
  return pivoting_.solve(system_);
}

bool IslandSolver::step(WorldView& world, const IslandContents& island) {
  const engine::WorldParameters& p = world.step.model.parameters;
  constants_ = {1 / world.step.dt, p.erp, p.cfm, p.contactSurfaceLayer};
  clear();
  readBodies(world, island);
  readJoints(world, island);
  readContacts(world, island);
  // Another engine would leave out armature and damping, which a controlled robot cannot do without.
  const auto hasInertia = [&](const RowRange& r) {
    const engine::Joint& j = world.step.model.joints[r.source];
    return std::any_of(j.axes.begin(), j.axes.end(), [](const auto& a) { return a.armature > 0 || a.damping > 0; });
  };
  if (system_.coupling.size() > static_cast<std::size_t>(world.maxCouplingRows) &&
      std::none_of(joints_.begin(), joints_.end(), hasInertia))
    return false;
  setExternalForces();
  if (!solve()) return false;
  writeResult(world);
  return true;
}

void IslandSolver::writeResult(WorldView& world) {
  writeWarmStart(world);
  // The new velocity is dt u.
  for (Node& n : system_.trees.nodes) {
    const double dt = world.step.dt;
    integrate(*n.dynamic, dt * n.motion.linear(), dt * n.motion.angular(), dt);
  }
  writeFeedback(world);
}

void IslandSolver::writeWarmStart(WorldView& world) const {
  for (const RowRange& range : joints_) {
    JointWarmStart& warmStart = world.joints[range.source];
    for (const Row& row : system_.rows.range(range.first, range.count)) {
      if (row.axis == kNoAxis) continue;
      warmStart.state[row.axis] = row.state;
      warmStart.frictionless[row.axis] = pyramidRows_.empty() ? row.state : row.frictionless;
      warmStart.stop[row.axis] = row.stop;
    }
  }
  for (const RowRange& range : contacts_) {
    ContactWarmStart::States& states = world.contacts.current(range.source);
    for (Index i = 0; i < range.count; ++i) states.rows[i] = system_.rows[range.first + i].state;
    states.frictionless = system_.rows[range.first].frictionless;
  }
}

/// The sum of J^T x of rows, for body A or B.
SpatialVector IslandSolver::totalForce(const RowRange& range, SpatialVector Row::*jacobian) const {
  SpatialVector sum = SpatialVector::zero();
  for (const Row& row : system_.rows.range(range.first, range.count)) sum.addScaled(row.*jacobian, row.force);
  return sum;
}

void IslandSolver::writeFeedback(WorldView& world) const {
  for (const RowRange& range : joints_) {
    const engine::Joint& joint = world.step.model.joints[range.source];
    if (!joint.wantsFeedback) continue;
    const SpatialVector onA = totalForce(range, &Row::jacobianA);
    const SpatialVector onB = joint.b != kNone ? totalForce(range, &Row::jacobianB) : SpatialVector::zero();
    world.step.state.joints[range.source] = {onA.linear(), onA.angular(), onB.linear(), onB.angular()};
  }
  for (const RowRange& range : contacts_) {
    engine::Contact& contact = world.step.contacts[range.source];
    if (!contact.feedback) continue;
    const Vec3 onBodyA = totalForce(range, &Row::jacobianA).linear();
    contact.forceOnA = ContactBodies(contact).reversed ? Vec3(-onBodyA) : onBodyA;
  }
}

}  // namespace spark::articulated
