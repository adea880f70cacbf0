#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>

#include "row_solver.h"

// Motors of a robot depend so much on each other, in coordinates of joints, that iterations need hundreds of rounds
// for them. Islands with few rows are solved as one linear complementarity problem by Bullet's implementation of
// Dantzig's algorithm (Baraff 1994, "Fast contact force computation for nonpenetrating rigid bodies"):
//
//     A x = b + w,   A = J M^-1 J^T + softness,   x impulses, w velocities that remain,
//
// with friction bounded by the normal impulses that a solution without friction has.

namespace spark::bullet {

double RowSolver::mobilityOf(std::size_t index, std::size_t other) const {
  // The matrix is symmetric, and a row of a single velocity has one element.
  if (offsets_[index] < 0 && offsets_[other] >= 0) std::swap(index, other);
  const btMultiBodySolverConstraint &row = *all_[index], &by = *all_[other];
  const int offset = offsets_[index];
  double sum = 0;
  const auto add = [&](const btMultiBody* body, int place, int response) {
    const btScalar *j = &m_data.m_jacobians[place], *r = &m_data.m_deltaVelocitiesUnitImpulse[response];
    if (offset >= 0) {
      sum += r[offset];
      return;
    }
    for (int i = 0, size = 6 + body->getNumDofs(); i < size; ++i) sum += j[i] * r[i];
  };
  for (const bool first : {true, false}) {
    const btMultiBody* body = first ? row.m_multiBodyA : row.m_multiBodyB;
    const int place = first ? row.m_jacAindex : row.m_jacBindex;
    if (!body) continue;
    if (body == by.m_multiBodyA) add(body, place, by.m_jacAindex);
    if (body == by.m_multiBodyB) add(body, place, by.m_jacBindex);
  }
  return sum;
}

void RowSolver::gather() {
  all_.clear();
  for (auto* kind : {&m_multiBodyNonContactConstraints, &m_multiBodyNormalContactConstraints,
                     &m_multiBodyFrictionContactConstraints})
    for (int i = 0; i < kind->size(); ++i) all_.push_back(&(*kind)[i]);
  offsets_.resize(all_.size(), -1);
}

bool RowSolver::solveDirectly() {
  gather();
  const auto n = all_.size();
  if (n > static_cast<std::size_t>(direct_)) return false;
  if (n == 0) return true;
  const int normals = m_multiBodyNonContactConstraints.size();
  const std::size_t frictions = n - static_cast<std::size_t>(m_multiBodyFrictionContactConstraints.size());
  Lcp& l = lcp_;
  l.a.resize(n * n);
  for (auto* v : {&l.x, &l.b, &l.w, &l.low, &l.high}) v->assign(n, 0);
  l.boundedBy.assign(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    const btMultiBodySolverConstraint& row = *all_[i];
    for (std::size_t k = 0; k < i; ++k) l.a[i * n + k] = l.a[k * n + i] = mobilityOf(i, k);
    // A row that repeats another one has an answer, too.
    l.a[i * n + i] = (1 + 1e-9) / row.m_jacDiagABInv;
    l.b[i] = row.m_rhs / row.m_jacDiagABInv;
    const bool friction = i >= frictions;
    l.low[i] = friction ? -row.m_friction : row.m_lowerLimit;
    l.high[i] = friction ? row.m_friction : row.m_upperLimit;
    if (friction) l.boundedBy[i] = normals + row.m_frictionIndex;
  }
  if (!btSolveDantzigLCP(static_cast<int>(n), l.a.data(), l.x.data(), l.b.data(), l.w.data(), 0, l.low.data(),
                         l.high.data(), l.boundedBy.data(), l.scratch))
    return false;
  if (!std::all_of(l.x.begin(), l.x.end(), [](double x) { return std::isfinite(x); })) return false;
  for (std::size_t i = 0; i < n; ++i) {
    btMultiBodySolverConstraint& row = *all_[i];
    row.m_appliedImpulse = l.x[i];
    if (row.m_multiBodyA)
      row.m_multiBodyA->applyDeltaVeeMultiDof2(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex], l.x[i]);
    if (row.m_multiBodyB)
      row.m_multiBodyB->applyDeltaVeeMultiDof2(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacBindex], l.x[i]);
  }
  return true;
}

btScalar RowSolver::solveGroupCacheFriendlyIterations(btCollisionObject**, int, btPersistentManifold**, int,
                                                      btTypedConstraint**, int, const btContactSolverInfo& info,
                                                      btIDebugDraw*) {
  if (solveDirectly()) return 0;
  return btMultiBodyConstraintSolver::solveGroupCacheFriendlyIterations(nullptr, 0, nullptr, 0, nullptr, 0, info,
                                                                        nullptr);
}

}  // namespace spark::bullet
