#pragma once
/// \file
/// Rows of constraints between multi-bodies, solved by Bullet's iterations.

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigLCP.h>

#include <vector>

#include "convert.h"
#include "tree_body.h"

namespace spark::bullet {

/// A link of a multi-body; without multi-body: the static world.
struct Side {
  btMultiBody* body = nullptr;
  int link = -1;  ///< -1: the base
};

/// A bound on the velocity of side a relative to b, along one direction:
///
///     velocity = target - softness * impulse,   low <= impulse <= high
struct Row {
  Side a, b;
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  ///< direction; one of them is zero
  Vec3 pointA = Vec3::Zero(), pointB = Vec3::Zero();   ///< where `linear` acts, world frame
  int offset = -1;                                     ///< in the vector of a's velocities, instead of a direction
  double target = 0;                                   ///< m/s or rad/s
  double softness = 0;                                 ///< 1/kg or 1/(kg m^2), 0 or more
  double low = -HUGE_VAL, high = HUGE_VAL;             ///< N s or Nm s
};

/// Writes the rows of an island, for the time of solve().
class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual void write(class RowSolver& rows) = 0;
};

/// Bullet's solver of constraints of multi-bodies, whose rows come from us: directly where they are few, else by
/// projected Gauss-Seidel.
class RowSolver : public btMultiBodyConstraintSolver {
 public:
  struct Options {
    double dt = 0.01;      ///< s
    int direct = 1000;     ///< largest number of rows of an island that is solved directly
    int iterations = 300;  ///< at most
    /// Change of velocity in one iteration that ends them [m/s or rad/s].
    double tolerance = 1e-6;
  };
  /// Solves the rows that `source` writes. The velocities of the multi-bodies change with
  /// btMultiBody::processDeltaVeeMultiDof2().
  void solve(RowSource& source, const Options& options);

  // For RowSource::write(): each returns the number of the row among its kind.
  int addRow(const Row& row);
  int addNormal(const Row& row);
  /// Friction of at most `mu` times the normal force of the row `normal`.
  int addFriction(const Row& row, int normal, double mu);

  // The rows and impulses of the last solve(), until the next one.
  const Row& row(int index) const { return kept_[static_cast<std::size_t>(index)]; }
  int rows() const { return m_multiBodyNonContactConstraints.size(); }
  double impulseOfRow(int row) const { return m_multiBodyNonContactConstraints[row].m_appliedImpulse; }
  double impulseOfNormal(int row) const { return m_multiBodyNormalContactConstraints[row].m_appliedImpulse; }
  double impulseOfFriction(int row) const { return m_multiBodyFrictionContactConstraints[row].m_appliedImpulse; }

 protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds,
                                        int numManifolds, btTypedConstraint** constraints, int numConstraints,
                                        const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                             btPersistentManifold** manifolds, int numManifolds,
                                             btTypedConstraint** constraints, int numConstraints,
                                             const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int numBodies,
                                         const btContactSolverInfo& info) override;

 private:
  int add(btMultiBodyConstraintArray& to, const Row& row);
  /// Appends the Jacobian of one side to `m_data`, with the velocity that a unit impulse gives. Returns its place.
  int addJacobian(const Row& row, const Side& side, double sign);
  void fill(const Row& row, const Side& side, double sign, btScalar* out);
  int deltaOf(btMultiBody& body);

  /// Lists all rows in all_ and offsets_.
  void gather();
  /// False: they are too many, or it failed.
  bool solveDirectly();
  /// The velocity along a row that a unit impulse along the other one gives.
  double mobilityOf(std::size_t row, std::size_t other) const;

  /// A linear complementarity problem, see btDantzigLCP.h.
  struct Lcp {
    std::vector<double> a, x, b, w, low, high;
    std::vector<int> boundedBy;
    btDantzigScratchMemory scratch;
  };
  Lcp lcp_;
  int direct_ = 0;
  std::vector<btMultiBodySolverConstraint*> all_;
  std::vector<int> offsets_;  ///< Row::offset, of all rows
  std::vector<Row> kept_;     ///< those of addRow()
  /// The last Jacobian of a single velocity.
  struct Single {
    const btMultiBody* body = nullptr;
    int offset = -1, place = 0;
  };
  Single last_;
  RowSource* source_ = nullptr;
  btContactSolverInfo info_;
  btAlignedObjectArray<btScalar> other_;  ///< Jacobian of the second side of one multi-body
};

}  // namespace spark::bullet
