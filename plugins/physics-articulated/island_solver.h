#pragma once
/// \file
/// Steps one island: reads its bodies, joints and contacts, solves, integrates and writes back.

#include "pivoting.h"
#include "topology.h"
#include "warm_start.h"

namespace spark::articulated {

/// What the islands of a world share during a step. Several threads may use it: each tree, joint and contact belongs to
/// one island. References are valid during the step.
struct WorldView {
  engine::Step& step;
  int maxCouplingRows;  ///< islands with more coupling rows are deferred
  const Topology& topology;
  const std::vector<engine::JointSoftness>& softness;  ///< by joint
  std::vector<JointWarmStart>& joints;                 ///< by joint of the step
  const engine::LawsByJoint& laws;
  ContactWarmStart& contacts;
  std::vector<Index>& firstNode;  ///< by tree: its first node in its island
};

/// The content of an island. Valid during the step.
struct IslandContents {
  std::span<const Index> trees;     ///< indices in Topology::trees
  std::span<const Index> contacts;  ///< indices in Step::contacts
  std::size_t bodies = 0;
};

/// Steps islands, one after the other. Memory is kept from island to island. One thread at a time uses it.
class IslandSolver {
 public:
  /// `maxPasses`: see Pivoting.
  explicit IslandSolver(std::uint32_t maxPasses) { pivoting_.maxPasses = maxPasses; }
  /// Allocates memory for islands of up to `bodies` bodies, `rows` rows, of which up to `couplingRows` are coupling
  /// rows, and trees of up to `depth` bodies from root to leaf.
  void reserve(std::size_t bodies, std::size_t rows, std::size_t couplingRows, std::size_t depth);
  /// Steps the island. Returns false, with its bodies, joints and contacts unchanged, if it has too many coupling rows
  /// (WorldView::maxCouplingRows) or no solution was found.
  bool step(WorldView& world, const IslandContents& island);
  /// For its counters.
  const Pivoting& pivoting() const { return pivoting_; }

 private:
  /// The rows of a joint or contact: `first` .. `first + count - 1`.
  struct RowRange {
    Index source, first, count;  ///< source: index in Model::joints or Step::contacts
    Index end() const { return first + count; }
  };
  void clear();
  static void makeFinite(Row& row);
  void readBodies(WorldView& world, const IslandContents& island);
  void readJoints(WorldView& world, const IslandContents& island);
  void readContacts(WorldView& world, const IslandContents& island);
  void setExternalForces();
  RowRange addJoint(WorldView& world, Index joint);
  void addCoupling(Index row);
  void fold(Index row);
  void addBounded(Index row);
  bool solve();
  double freeMobility(const Row& row) const;
  double freeMobility(const SpatialVector& jacobian, Index node) const;
  void writeResult(WorldView& world);
  void writeWarmStart(WorldView& world) const;
  void writeFeedback(WorldView& world) const;
  SpatialVector totalForce(const RowRange& rows, SpatialVector Row::*jacobian) const;
  Index nodeOf(const WorldView& world, Index body) const;
  Node& node(Index i) { return system_.trees.nodes[i]; }

  System system_;
  Pivoting pivoting_;
  StepConstants constants_{};
  double motionTolerance_ = 0;  ///< of the island's bounded rows [m/s^2 or rad/s^2]
  std::vector<RowRange> joints_, contacts_;
  std::vector<Index> pyramidRows_;  ///< friction rows whose bounds depend on the force of another row
};

}  // namespace spark::articulated
