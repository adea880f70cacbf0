#include "topology.h"

#include <algorithm>

namespace spark::articulated {

/// The joints of each body, in order of creation, as a compressed adjacency list: those of body i are
/// joints[start[i]] .. joints[start[i + 1] - 1].
struct Topology::JointsOfBodies {
  std::vector<Index> start, joints;

  explicit JointsOfBodies(const engine::Model& model) : start(model.bodies.size() + 2, 0) {
    const auto forEachEnd = [&](auto&& visit) {
      for (std::size_t j = 0; j < model.joints.size(); ++j)
        for (const Index body : {model.joints[j].a, model.joints[j].b})
          if (body != kNone) visit(body, toIndex(j));
    };
    // Counting sort. start is shifted by one, so that filling the list moves it to its final place.
    forEachEnd([&](Index body, Index) { ++start[body + 2]; });
    for (std::size_t i = 2; i < start.size(); ++i) start[i] += start[i - 1];
    joints.resize(start.back());
    forEachEnd([&](Index body, Index joint) { joints[start[body + 1]++] = joint; });
  }
  std::span<const Index> of(Index body) const {
    return std::span(joints).subspan(start[body], start[body + 1] - start[body]);
  }
};

/// Adds the tree of `root`, breadth first. `worldJoint` connects the root to the world, unless it is kNone.
void Topology::growTree(const engine::Model& model, const JointsOfBodies& joints, Index root, Index worldJoint,
                        std::vector<bool>& used) {
  Tree tree{toIndex(treeBodies.size()), 0, toIndex(loopJoints.size()), 0};
  const auto add = [&](Index body, Index parent, Index joint) {
    treeBodyOf[body] = toIndex(treeBodies.size());
    treeOf[body] = toIndex(trees.size());
    treeBodies.push_back({body, parent, joint});
    if (joint != kNone) used[joint] = true;
  };
  add(root, kNone, worldJoint);
  for (Index parent = tree.begin; parent < treeBodies.size(); ++parent) {
    const Index body = treeBodies[parent].body;
    for (const Index joint : joints.of(body)) {
      if (used[joint]) continue;
      const engine::Joint& j = model.joints[joint];
      const Index other = j.a == body ? j.b : j.a;
      // A joint to a new body makes it a child; a joint to the world or to a body of this tree closes a loop.
      if (other != kNone && treeBodyOf[other] == kNone) {
        add(other, parent, joint);
        continue;
      }
      used[joint] = true;
      loopJoints.push_back(joint);
    }
  }
  tree.end = toIndex(treeBodies.size());
  tree.loopEnd = toIndex(loopJoints.size());
  trees.push_back(tree);
}

void Topology::findMaxDepth() {
  std::vector<std::size_t> depths(treeBodies.size(), 1);
  maxDepth = 0;
  for (std::size_t i = 0; i < treeBodies.size(); ++i) {
    if (treeBodies[i].parent != kNone) depths[i] = depths[treeBodies[i].parent] + 1;
    maxDepth = std::max(maxDepth, depths[i]);
  }
}

void Topology::build(const engine::Model& model) {
  const JointsOfBodies joints(model);
  const std::size_t n = model.bodies.size();
  treeBodies.clear();
  trees.clear();
  loopJoints.clear();
  treeBodyOf.assign(n, kNone);
  treeOf.assign(n, kNone);
  std::vector<bool> used(model.joints.size(), false);
  const auto worldJointOf = [&](Index body) {
    for (const Index joint : joints.of(body))
      if (model.joints[joint].b == kNone) return joint;
    return kNone;
  };
  // Bodies with a joint to the world are roots if they can be: their joint is then part of the tree, not a loop.
  for (const bool connectedToWorld : {true, false})
    for (Index body = 0; body < n; ++body) {
      if (treeBodyOf[body] != kNone) continue;
      const Index joint = worldJointOf(body);
      if (!connectedToWorld || joint != kNone) growTree(model, joints, body, joint, used);
    }
  findMaxDepth();
}

}  // namespace spark::articulated
