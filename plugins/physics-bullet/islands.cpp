#include "islands.h"

#include <algorithm>
#include <numeric>

namespace spark::bullet {

Index Islands::rootOf(Index tree) {
  while (root_[tree] != tree) tree = root_[tree] = root_[root_[tree]];
  return tree;
}

void Islands::unite(Index a, Index b) {
  a = rootOf(a), b = rootOf(b);
  root_[std::max(a, b)] = std::min(a, b);
}

void Islands::find(const engine::Step& step, std::size_t trees, const std::vector<Index>& treeOf,
                   const std::vector<Index>& joints) {
  root_.resize(trees);
  std::iota(root_.begin(), root_.end(), Index{0});
  for (const Index i : joints) {
    const engine::Joint& j = step.model.joints[i];
    if (j.b != kNone) unite(treeOf[j.a], treeOf[j.b]);
  }
  for (const engine::Contact& c : step.contacts)
    if (c.solve && c.bodyA != kNone && c.bodyB != kNone) unite(treeOf[c.bodyA], treeOf[c.bodyB]);

  // Islands are numbered by their first tree.
  island_.assign(trees, kNone);
  Index count = 0;
  for (Index i = 0; i < trees; ++i) {
    const Index root = rootOf(i);
    if (root == i)
      island_[i] = count++;
    else
      island_[i] = island_[root];
  }
  active_.assign(count, 0);
  for (Index i = 0; i < treeOf.size(); ++i)
    if (step.state.bodies[i].awake && step.steps(i)) active_[island_[treeOf[i]]] = 1;

  trees_.build(count, trees, [&](Index i) { return island_[i]; });
  joints_.build(count, joints.size(), [&](Index i) { return island_[treeOf[step.model.joints[joints[i]].a]]; });
  contacts_.build(count, step.contacts.size(), [&](Index i) {
    const engine::Contact& c = step.contacts[i];
    const Index body = c.bodyA != kNone ? c.bodyA : c.bodyB;
    return c.solve && body != kNone ? island_[treeOf[body]] : kNone;
  });
}

}  // namespace spark::bullet
