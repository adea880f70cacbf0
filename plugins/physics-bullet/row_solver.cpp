#include "row_solver.h"

#include <algorithm>

namespace spark::bullet {

void RowSolver::solve(RowSource& source, const Options& options) {
  source_ = &source;
  direct_ = options.direct;
  info_.m_timeStep = options.dt;
  info_.m_numIterations = options.iterations;
  info_.m_leastSquaresResidualThreshold = options.tolerance * options.tolerance;
  info_.m_solverMode = SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_DISABLE_IMPLICIT_CONE_FRICTION;
  setRandSeed(0);
  solveMultiBodyGroup(nullptr, 0, nullptr, 0, nullptr, 0, nullptr, 0, info_, nullptr, nullptr);
}

btScalar RowSolver::solveGroupCacheFriendlySetup(btCollisionObject**, int, btPersistentManifold**, int,
                                                 btTypedConstraint**, int, const btContactSolverInfo& info,
                                                 btIDebugDraw*) {
  btMultiBodyConstraintSolver::solveGroupCacheFriendlySetup(nullptr, 0, nullptr, 0, nullptr, 0, info, nullptr);
  offsets_.clear();
  kept_.clear();
  last_ = {};
  source_->write(*this);
  return 0;
}

btScalar RowSolver::solveGroupCacheFriendlyFinish(btCollisionObject**, int, const btContactSolverInfo& info) {
  // Without that of btMultiBodyConstraintSolver: it writes to manifolds and links that we do not have.
  // NOLINTNEXTLINE(bugprone-parent-virtual-call)
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(nullptr, 0, info);
}

int RowSolver::addRow(const Row& row) {
  offsets_.push_back(row.offset);
  kept_.push_back(row);
  return add(m_multiBodyNonContactConstraints, row);
}
int RowSolver::addNormal(const Row& row) { return add(m_multiBodyNormalContactConstraints, row); }
int RowSolver::addFriction(const Row& row, int normal, double mu) {
  const int at = add(m_multiBodyFrictionContactConstraints, row);
  m_multiBodyFrictionContactConstraints[at].m_frictionIndex = normal;
  m_multiBodyFrictionContactConstraints[at].m_friction = std::min(mu, 1e30);
  return at;
}

/// Where the velocity changes of a multi-body are while Bullet solves.
int RowSolver::deltaOf(btMultiBody& body) {
  if (body.getCompanionId() < 0) {
    const int size = 6 + body.getNumDofs(), first = m_data.m_deltaVelocities.size();
    body.setCompanionId(first);
    m_data.m_deltaVelocities.resize(first + size, 0);
  }
  return body.getCompanionId();
}

void RowSolver::fill(const Row& row, const Side& side, double sign, btScalar* out) {
  if (row.offset >= 0) {
    std::fill_n(out, 6 + side.body->getNumDofs(), 0.0);
    out[row.offset] = sign;
    return;
  }
  const Vec3& point = sign > 0 ? row.pointA : row.pointB;
  side.body->fillConstraintJacobianMultiDof(side.link, toBullet(point), toBullet(Vec3(sign * row.angular)),
                                            toBullet(Vec3(sign * row.linear)), out, m_data.scratch_r, m_data.scratch_v,
                                            m_data.scratch_m);
}

int RowSolver::addJacobian(const Row& row, const Side& side, double sign) {
  // Motor and stop of an axis share theirs.
  if (row.offset >= 0 && row.offset == last_.offset && side.body == last_.body) return last_.place;
  const int size = 6 + side.body->getNumDofs(), at = m_data.m_jacobians.size();
  last_ = {side.body, row.offset, at};
  m_data.m_jacobians.resizeNoInitialize(at + size);
  m_data.m_deltaVelocitiesUnitImpulse.resizeNoInitialize(at + size);
  fill(row, side, sign, &m_data.m_jacobians[at]);
  if (sign > 0 && row.b.body == side.body) {
    other_.resizeNoInitialize(size);
    fill(row, row.b, -1, &other_[0]);
    for (int i = 0; i < size; ++i) m_data.m_jacobians[at + i] += other_[i];
  }
  side.body->calcAccelerationDeltasMultiDof(&m_data.m_jacobians[at], &m_data.m_deltaVelocitiesUnitImpulse[at],
                                            m_data.scratch_r, m_data.scratch_v);
  return at;
}

int RowSolver::add(btMultiBodyConstraintArray& to, const Row& row) {
  btMultiBodySolverConstraint& c = to.expandNonInitializing();
  new (&c) btMultiBodySolverConstraint();
  double mobility = 0, velocity = 0;
  const auto addSide = [&](const Side& side, double sign, btMultiBody*& body, int& link, int& jacobian, int& delta) {
    if (!side.body) return;
    body = side.body;
    link = side.link;
    jacobian = addJacobian(row, side, sign);
    delta = deltaOf(*side.body);
    const btScalar *j = &m_data.m_jacobians[jacobian], *response = &m_data.m_deltaVelocitiesUnitImpulse[jacobian];
    const btScalar* speeds = side.body->getVelocityVector();
    for (int i = 0; i < 6 + side.body->getNumDofs(); ++i) mobility += j[i] * response[i], velocity += j[i] * speeds[i];
  };
  addSide(row.a, 1, c.m_multiBodyA, c.m_linkA, c.m_jacAindex, c.m_deltaVelAindex);
  if (row.offset < 0 && row.b.body != row.a.body)
    addSide(row.b, -1, c.m_multiBodyB, c.m_linkB, c.m_jacBindex, c.m_deltaVelBindex);
  const double sum = mobility + row.softness;
  const double inverse = sum > 0 ? 1 / sum : 0;
  c.m_jacDiagABInv = inverse > 0 && std::isfinite(inverse) ? inverse : 1e-300;
  c.m_rhs = (row.target - velocity) * c.m_jacDiagABInv;
  c.m_cfm = row.softness * c.m_jacDiagABInv;
  c.m_rhsPenetration = 0;
  c.m_lowerLimit = row.low;
  c.m_upperLimit = row.high;
  c.m_appliedImpulse = 0;
  c.m_appliedPushImpulse = 0;
  c.m_friction = 0;
  c.m_frictionIndex = 0;
  c.m_originalContactPoint = nullptr;
  c.m_overrideNumSolverIterations = 0;
  return to.size() - 1;
}

}  // namespace spark::bullet
