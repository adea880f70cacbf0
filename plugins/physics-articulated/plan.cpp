#include "plan.h"

#include <utility>

namespace spark::articulated {

int Plan::rootOf(int tree) {
  auto t = static_cast<std::size_t>(tree);
  while (above_[t] != static_cast<int>(t)) {
    above_[t] = above_[static_cast<std::size_t>(above_[t])];
    t = static_cast<std::size_t>(above_[t]);
  }
  return static_cast<int>(t);
}

void Plan::unite(int a, int b) {
  a = rootOf(a), b = rootOf(b);
  if (a != b) above_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

IslandPlan Plan::operator[](std::size_t i) const {
  const Range& r = ranges_[static_cast<std::size_t>(islands_[i])];
  const std::span trees(trees_), contacts(contacts_);
  return {trees.subspan(static_cast<std::size_t>(r.firstTree), static_cast<std::size_t>(r.trees)),
          contacts.subspan(static_cast<std::size_t>(r.firstContact), static_cast<std::size_t>(r.contacts)),
          static_cast<std::size_t>(r.bodies)};
}

void Plan::find(const engine::SolverStep& step, const Topology& topology) {
  const std::size_t n = topology.trees.size();
  const auto treeOf = [&](const engine::SolverBody& body) { return topology.treeOf[body.index]; };
  above_.resize(n);
  for (std::size_t t = 0; t < n; ++t) above_[t] = static_cast<int>(t);
  for (const engine::SolverPair& pair : step.pairs)
    if (pair.a && pair.b) unite(treeOf(*pair.a), treeOf(*pair.b));

  // Count, then deal out in order.
  ranges_.assign(n, {});
  const auto rangeOf = [&](int tree) -> Range& { return ranges_[static_cast<std::size_t>(rootOf(tree))]; };
  for (std::size_t t = 0; t < n; ++t) {
    Range& r = rangeOf(static_cast<int>(t));
    const Tree& tree = topology.trees[t];
    ++r.trees;
    r.bodies += tree.end - tree.start;
    r.coupling += kJointRows * (tree.extraEnd - tree.extraStart);
    for (int i = tree.start; i < tree.end && !r.awake; ++i)
      r.awake = step.bodies[static_cast<std::size_t>(topology.branches[static_cast<std::size_t>(i)].body)]->awake;
  }
  std::size_t contacts = 0;
  for (const engine::SolverPair& pair : step.pairs)
    if (pair.a) {
      Range& r = rangeOf(treeOf(*pair.a));
      ++r.contacts, ++contacts;
      if (pair.b) r.coupling += kContactRows;
    }
  trees_.resize(n);
  contacts_.resize(contacts);
  islands_.clear();
  mostBodies_ = mostRows_ = mostCoupling_ = 0;
  int firstTree = 0, firstContact = 0;
  for (std::size_t t = 0; t < n; ++t) {
    Range& r = ranges_[t];
    if (r.trees == 0) continue;
    r.firstTree = std::exchange(firstTree, firstTree + r.trees);
    r.firstContact = std::exchange(firstContact, firstContact + r.contacts);
    if (r.awake) {
      islands_.push_back(static_cast<int>(t));
      mostBodies_ = std::max(mostBodies_, static_cast<std::size_t>(r.bodies));
      mostRows_ = std::max(mostRows_, static_cast<std::size_t>(r.bodies) * kJointRows +
                                          static_cast<std::size_t>(r.contacts) * kContactRows +
                                          static_cast<std::size_t>(r.coupling));
      mostCoupling_ = std::max(mostCoupling_, static_cast<std::size_t>(r.coupling));
    }
    r.trees = r.contacts = 0;
  }
  for (std::size_t t = 0; t < n; ++t) {
    Range& r = rangeOf(static_cast<int>(t));
    trees_[static_cast<std::size_t>(r.firstTree + r.trees++)] = static_cast<int>(t);
  }
  for (std::size_t c = 0; c < step.pairs.size(); ++c) {
    if (!step.pairs[c].a) continue;
    Range& r = rangeOf(treeOf(*step.pairs[c].a));
    contacts_[static_cast<std::size_t>(r.firstContact + r.contacts++)] = static_cast<int>(c);
  }
}

}  // namespace spark::articulated
