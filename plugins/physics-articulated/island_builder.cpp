#include "island_builder.h"

#include <utility>

namespace spark::articulated {

IslandContents IslandBuilder::operator[](std::size_t i) const {
  const Range& r = ranges_[islands_[i]];
  const std::span trees(trees_), contacts(contacts_);
  return {trees.subspan(r.firstTree, r.trees), contacts.subspan(r.firstContact, r.contacts), r.bodies};
}

void IslandBuilder::build(const engine::Step& step, const Topology& topology) {
  // Contacts between bodies connect trees; the static world connects nothing.
  sets_.reset(topology.trees.size());
  for (const engine::Contact& contact : step.contacts)
    if (const ContactBodies pair(contact); pair.b != kNone)
      sets_.merge(topology.treeOf[pair.a], topology.treeOf[pair.b]);
  // A counting sort of trees and contacts by island.
  count(step, topology);
  layOut();
  fill(step, topology);
}

/// Counts trees, contacts, bodies and coupling rows of each island, and finds out whether it is awake.
void IslandBuilder::count(const engine::Step& step, const Topology& topology) {
  const std::size_t n = topology.trees.size();
  ranges_.assign(n, {});
  for (Index t = 0; t < n; ++t) {
    Range& r = rangeOf(t);
    const Tree& tree = topology.trees[t];
    ++r.trees;
    r.bodies += tree.end - tree.begin;
    r.couplingRows += kMaxJointRows * (tree.loopEnd - tree.loopBegin);
    for (Index i = tree.begin; i < tree.end && !r.awake; ++i) {
      const Index body = topology.treeBodies[i].body;
      r.awake = step.state.bodies[body].awake && step.steps(body);
    }
  }
  std::size_t contacts = 0;
  for (const engine::Contact& contact : step.contacts)
    if (const ContactBodies pair(contact); pair.a != kNone) {
      Range& r = rangeOf(topology.treeOf[pair.a]);
      ++r.contacts, ++contacts;
      if (pair.b != kNone) r.couplingRows += kMaxContactRows;
    }
  trees_.resize(n);
  contacts_.resize(contacts);
}

/// Gives each island its range of trees_ and contacts_, lists the awake ones, and finds the largest sizes. The counts
/// become 0, for fill() to count anew.
void IslandBuilder::layOut() {
  islands_.clear();
  maxBodies_ = maxRows_ = maxCouplingRows_ = 0;
  Index firstTree = 0, firstContact = 0;
  for (Index t = 0; t < ranges_.size(); ++t) {
    Range& r = ranges_[t];
    if (r.trees == 0) continue;
    r.firstTree = std::exchange(firstTree, firstTree + r.trees);
    r.firstContact = std::exchange(firstContact, firstContact + r.contacts);
    if (r.awake) {
      islands_.push_back(t);
      const std::size_t bodies = r.bodies, contacts = r.contacts, couplingRows = r.couplingRows;
      maxBodies_ = std::max(maxBodies_, bodies);
      maxRows_ = std::max(maxRows_, bodies * kMaxJointRows + contacts * kMaxContactRows + couplingRows);
      maxCouplingRows_ = std::max(maxCouplingRows_, couplingRows);
    }
    r.trees = r.contacts = 0;
  }
}

/// Writes trees and contacts to the ranges of their islands, in their own order.
void IslandBuilder::fill(const engine::Step& step, const Topology& topology) {
  for (Index t = 0; t < topology.trees.size(); ++t) {
    Range& r = rangeOf(t);
    trees_[r.firstTree + r.trees++] = t;
  }
  for (std::size_t c = 0; c < step.contacts.size(); ++c) {
    const ContactBodies pair(step.contacts[c]);
    if (pair.a == kNone) continue;
    Range& r = rangeOf(topology.treeOf[pair.a]);
    contacts_[r.firstContact + r.contacts++] = toIndex(c);
  }
}

}  // namespace spark::articulated
