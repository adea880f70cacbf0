#pragma once
/// \file
/// One island from the engine's bodies and back: reads, solves, moves. An Island is used again and again, by one thread
/// at a time, and keeps its memory.

#include "memory.h"
#include "pivoting.h"
#include "topology.h"

namespace spark::articulated {

/// What the islands of a world share during a step. Each tree and each joint belongs to one island.
struct WorldView {
  engine::SolverStep& step;
  const Topology& topology;
  std::vector<JointMemory>& memory;  ///< by joint
  ContactMemory& contacts;
  std::vector<int>& firstNode;  ///< by tree: its first node in its island
};

/// Trees (indices in Topology::trees) and contacts (indices in SolverStep::contacts) of an island.
struct IslandPlan {
  std::span<const int> trees, contacts;
  std::size_t bodies = 0;
};

class Island {
 public:
  explicit Island(int mostPasses) { pivoting_.mostPasses = mostPasses; }
  /// Makes room, so that nothing need be allocated later: for bodies, rows, those of them that are no part of a tree,
  /// and trees of a depth.
  void reserve(std::size_t bodies, std::size_t rows, std::size_t coupling, std::size_t depth);
  /// Steps the island; false when it is left to the engine, and then nothing is changed.
  bool step(WorldView& world, const IslandPlan& plan);
  const Pivoting& pivoting() const { return pivoting_; }

 private:
  /// Rows first..first+count of a joint or contact.
  struct Part {
    int index, first, count;
  };
  void readBodies(WorldView& world, const IslandPlan& plan);
  void readJoints(WorldView& world, const IslandPlan& plan);
  void readContacts(WorldView& world, const IslandPlan& plan);
  void gatherForces();
  Part addJoint(WorldView& world, int joint);
  void couple(int index);
  void joinBody(Row& row, int index);
  double mobility(const Row& row) const;
  double mobility(const Six& along, int node) const;
  void bound(int index);
  bool settle();
  void write(WorldView& world);
  void writeFeedback(WorldView& world) const;
  int nodeOf(const WorldView& world, const engine::SolverBody* body) const;
  Node& node(int i) { return system_.trees.nodes[static_cast<std::size_t>(i)]; }

  System system_;
  Pivoting pivoting_;
  RowScale scale_{};
  double slack_ = 0;  ///< of motions, see Bounded
  std::vector<Part> joints_, contacts_;
  std::vector<int> pyramid_;  ///< rows whose bounds wait for other rows' forces
};

}  // namespace spark::articulated
