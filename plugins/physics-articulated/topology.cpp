#include "topology.h"

#include <algorithm>

namespace spark::articulated {

namespace {

/// Joints by body, each in order of creation.
struct JointsOfBodies {
  std::vector<int> start, joints;
  explicit JointsOfBodies(const engine::SolverStep& step) : start(step.bodies.size() + 2, 0) {
    const auto each = [&](auto&& what) {
      for (std::size_t j = 0; j < step.joints.size(); ++j)
        for (const engine::SolverBody* body : {step.joints[j]->a, step.joints[j]->b})
          if (body) what(body->index, static_cast<int>(j));
    };
    each([&](std::uint32_t body, int) { ++start[body + 2]; });
    for (std::size_t i = 2; i < start.size(); ++i) start[i] += start[i - 1];
    joints.resize(static_cast<std::size_t>(start.back()));
    each([&](std::uint32_t body, int joint) { joints[static_cast<std::size_t>(start[body + 1]++)] = joint; });
  }
};

int heldToWorldBy(const engine::SolverStep& step, const JointsOfBodies& of, std::size_t body) {
  for (int i = of.start[body]; i < of.start[body + 1]; ++i) {
    const int joint = of.joints[static_cast<std::size_t>(i)];
    if (!step.joints[static_cast<std::size_t>(joint)]->b) return joint;
  }
  return -1;
}

}  // namespace

void Topology::find(const engine::SolverStep& step) {
  const JointsOfBodies of(step);
  const std::size_t n = step.bodies.size();
  branches.clear();
  trees.clear();
  extraJoints.clear();
  branchOf.assign(n, -1);
  treeOf.assign(n, -1);
  std::vector<bool> used(step.joints.size(), false);
  const auto grow = [&](std::size_t root, int worldJoint) {
    Tree tree{static_cast<int>(branches.size()), 0, static_cast<int>(extraJoints.size()), 0};
    const auto add = [&](std::size_t body, int parent, int joint) {
      branchOf[body] = static_cast<int>(branches.size());
      treeOf[body] = static_cast<int>(trees.size());
      branches.push_back({static_cast<int>(body), parent, joint});
      if (joint >= 0) used[static_cast<std::size_t>(joint)] = true;
    };
    add(root, -1, worldJoint);
    for (int at = tree.start; at < static_cast<int>(branches.size()); ++at) {
      const auto body = static_cast<std::size_t>(branches[static_cast<std::size_t>(at)].body);
      for (int i = of.start[body]; i < of.start[body + 1]; ++i) {
        const int joint = of.joints[static_cast<std::size_t>(i)];
        if (used[static_cast<std::size_t>(joint)]) continue;
        const engine::SolverJoint& j = *step.joints[static_cast<std::size_t>(joint)];
        const engine::SolverBody* other = j.a->index == body ? j.b : j.a;
        if (other && branchOf[other->index] < 0) {
          add(other->index, at, joint);
          continue;
        }
        used[static_cast<std::size_t>(joint)] = true;
        extraJoints.push_back(joint);
      }
    }
    tree.end = static_cast<int>(branches.size());
    tree.extraEnd = static_cast<int>(extraJoints.size());
    trees.push_back(tree);
  };
  for (const bool held : {true, false})
    for (std::size_t body = 0; body < n; ++body) {
      if (branchOf[body] >= 0) continue;
      const int joint = heldToWorldBy(step, of, body);
      if (!held || joint >= 0) grow(body, joint);
    }
  std::vector<std::size_t> depths(branches.size(), 1);
  depth = 0;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    if (branches[i].parent >= 0) depths[i] = depths[static_cast<std::size_t>(branches[i].parent)] + 1;
    depth = std::max(depth, depths[i]);
  }
}

}  // namespace spark::articulated
