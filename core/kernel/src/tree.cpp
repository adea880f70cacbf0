#include "tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/running.h"

namespace spark::detail {

/// Marks a leaf as being linked, moved or unlinked.
struct Tree::Changing {
  Changing(Tree& t, Leaf& l) : tree(t), leaf(l), before(l.changing_) {
    leaf.changing_ = true;
    ++tree.changing_;
  }
  ~Changing() {
    leaf.changing_ = before;
    --tree.changing_;
  }
  Changing(const Changing&) = delete;
  Changing& operator=(const Changing&) = delete;
  Tree& tree;
  Leaf& leaf;
  bool before;
};

void Tree::plant(std::unique_ptr<Leaf> root) {
  root->name_.clear();
  root_.reset(static_cast<Node*>(root.release()));
  root_->linked_ = true;
  classes = root_->create("Node", "classes").asNode();
  plugins = root_->create("Node", "plugins").asNode();
}

void Tree::fell() {
  for (const char* top : {"usr", "sys"})
    while (Leaf* leaf = root_->child(top)) detach(*leaf);
  // Then the other children of the root, last to first. An object that leaves may add and remove others.
  const auto& all = root_->children_;
  for (std::size_t i = all.size(); i-- > 0; i = std::min(i, all.size()))
    if (Leaf* leaf = all[i].get(); leaf != classes && leaf != plugins) detach(*leaf);
}

void Tree::uproot() {
  detach(*std::exchange(classes, nullptr));
  detach(*std::exchange(plugins, nullptr));
  root_.reset();
}

void Tree::markChanged(Node* node) {
  ++version_;
  for (; node; node = node->parent_) node->changedAt_ = version_;
}

void Tree::updateOrder() {
  if (isOrdered()) return;
  orderedAt_ = version_;
  order_.clear();
  std::uint32_t post = 0;
  number(*root_, post);
}

void Tree::number(Leaf& leaf, std::uint32_t& post) {
  leaf.preOrder_ = static_cast<std::uint32_t>(order_.size());
  order_.push_back(&leaf);
  if (Node* node = leaf.asNode())
    for (const auto& c : node->children_) number(*c, post);
  leaf.lastBelow_ = static_cast<std::uint32_t>(order_.size() - 1);
  leaf.postOrder_ = post++;
}

void Tree::adopt(Leaf& leaf, ClassObject& c) {
  leaf.class_ = &c;
  if (leaf.id_ == 0) leaf.id_ = nextId_++;
  if (leaf.name_.empty()) leaf.name_ = c.name();
}

// Adding, removing, moving.

Leaf& Tree::attach(Node& parent, std::unique_ptr<Leaf> leaf) {
  Leaf& added = *leaf;
  int levels = 1;
  for (const Node* up = parent.parent_; up; up = up->parent_) ++levels;
  if (levels > Node::kMostLevels)
    throw Error(fmt::format("cannot add a {} here: the tree is at most {} levels deep", added.class_->name(),
                            Node::kMostLevels));
  if (added.name_.empty()) added.name_ = added.class_->name();
  parent.children_.push_back(std::move(leaf));
  added.parent_ = &parent;
  parent.rememberName(added);
  if (!parent.linked_) return added;
  try {
    link(added);
  } catch (...) {
    emptyReferences(added);
    const std::unique_ptr<Leaf> dying = take(added);
    throw;
  }
  return added;
}

Leaf& Tree::attachSorted(Node& parent, std::unique_ptr<Leaf> leaf) {
  Leaf& added = attach(parent, std::move(leaf));
  // attach() has already counted the change.
  auto& list = parent.children_;
  for (std::size_t i = list.size() - 1; i > 0 && list[i]->name() < list[i - 1]->name(); --i)
    std::swap(list[i], list[i - 1]);
  return added;
}

void Tree::detach(Leaf& child) {
  if (child.linked_) unlink(child);
  emptyReferences(child);
  const std::unique_ptr<Leaf> dying = take(child);
  if (Node* node = dying->asNode()) destroyBelow(*node);
}

std::unique_ptr<Leaf> Tree::take(Leaf& child) {
  Node& parent = *child.parent_;
  parent.forgetNames();
  const auto at =
      std::find_if(parent.children_.begin(), parent.children_.end(), [&](const auto& c) { return c.get() == &child; });
  std::unique_ptr<Leaf> taken = std::move(*at);
  parent.children_.erase(at);
  return taken;
}

void Tree::move(Leaf& child, Node& to) {
  Node& from = *child.parent_;
  if (child.linked_ && !to.linked_) unlink(child);
  // Memory is reserved first, so that the move between the two parents cannot fail.
  const auto carryTo = [&](Node& target) {
    Node& source = *child.parent_;
    target.children_.reserve(target.children_.size() + 1);
    target.forgetNames();
    std::unique_ptr<Leaf> moving = take(child);
    child.parent_ = &target;
    target.children_.push_back(std::move(moving));
    markChanged(&source);
    markChanged(&target);
  };
  carryTo(to);
  try {
    if (child.linked_ == to.linked_)
      moved(child);
    else
      link(child);
  } catch (...) {
    carryTo(from);
    try {
      if (child.linked_) moved(child);
    } catch (const std::exception& e) {
      kernel_.log().error("{} could not be moved, nor back: {}", child.path(), e.what());
    }
    throw;
  }
}

void Tree::rename(Leaf& leaf, std::string name) {
  if (leaf.parent_) leaf.parent_->forgetNames();
  leaf.name_ = std::move(name);
  if (leaf.linked_) leaf.kernel().tree().markChanged(leaf.parent_);
}

/// Empties all references to a leaf and its descendants.
void Tree::emptyReferences(Leaf& leaf) {
  if (leaf.life_) leaf.life_->leaf = nullptr;
  if (Node* node = leaf.asNode())
    for (const auto& c : node->children_) emptyReferences(*c);
}

/// Destroys all descendants, children before parents and first to last. They are unlinked, and references to them are
/// empty.
void Tree::destroyBelow(Node& node) {
  // A destructor may add children, so the list is read again.
  while (!node.children_.empty()) {
    node.forgetNames();
    std::vector<std::unique_ptr<Leaf>> dying = std::move(node.children_);
    node.children_.clear();
    for (std::unique_ptr<Leaf>& leaf : dying) {
      if (Node* inner = leaf->asNode()) destroyBelow(*inner);
      leaf.reset();
    }
  }
}

// Linking and unlinking.

void Tree::link(Leaf& leaf) {
  const Changing guard(*this, leaf);
  leaf.linked_ = true;
  markChanged(leaf.parent_);
  bool entered = false;  // onLink() has succeeded, so that onUnlink() must follow
  try {
    {
      const NowRunning now("onLink", &leaf);
      leaf.onLink();
    }
    entered = true;
    kernel_.events().hook(leaf);
    if (Node* node = leaf.asNode()) linkChildren(*node);
    leaf.class_->warnOfMissing(leaf);
  } catch (...) {
    unlinkChildren(leaf);
    if (entered) callOnUnlink(leaf);
    kernel_.events().unhook(leaf);
    leaf.linked_ = false;
    markChanged(leaf.parent_);
    throw;
  }
}

void Tree::linkChildren(Node& node) {
  for (std::size_t i = 0; i < node.children_.size();) {
    Leaf& child = *node.children_[i];
    if (!child.linked_) link(child);
    // If linking has changed the list, begin again; linked children are skipped.
    i = i < node.children_.size() && node.children_[i].get() == &child ? i + 1 : 0;
  }
}

void Tree::unlink(Leaf& leaf) {
  const Changing guard(*this, leaf);
  unlinkChildren(leaf);
  callOnUnlink(leaf);
  unlinkChildren(leaf);  // what onUnlink made
  kernel_.events().unhook(leaf);
  leaf.linked_ = false;
  markChanged(leaf.parent_);
}

void Tree::unlinkChildren(Leaf& leaf) {
  Node* node = leaf.asNode();
  if (!node) return;
  for (std::size_t i = 0; i < node->children_.size();) {
    Leaf& child = *node->children_[i];
    if (child.linked_) unlink(child);
    // If unlinking has changed the list, begin again; unlinked children are skipped.
    i = i < node->children_.size() && node->children_[i].get() == &child ? i + 1 : 0;
  }
}

void Tree::callOnUnlink(Leaf& leaf) {
  const NowRunning now("onUnlink", &leaf);
  try {
    leaf.onUnlink();
  } catch (const std::exception& e) {
    kernel_.log().error("{} (class {}) failed to leave the tree: {}", leaf.path(), leaf.class_->name(), e.what());
  }
}

void Tree::moved(Leaf& leaf) {
  const Changing guard(*this, leaf);
  {
    const NowRunning now("onMoved", &leaf);
    leaf.onMoved();
  }
  leaf.class_->warnOfMissing(leaf);
  if (Node* node = leaf.asNode())
    for (std::size_t i = 0; i < node->children_.size(); ++i) moved(*node->children_[i]);
}

// Objects that must not be removed.

void Tree::refuseUsed(const Leaf& leaf, bool rename, const std::string& doing) const {
  // The number of levels that `low` is below `high`; -1 if it is not below it.
  const auto levels = [](const Leaf* low, const Leaf* high) {
    for (int n = 0; low; low = low->parent(), ++n)
      if (low == high) return n;
    return -1;
  };
  for (const InUse* use = inUse_; use; use = use->next_) {
    const Leaf* used = use->leaf_.get();
    if (!used) continue;
    // Refused: the used leaf, its ancestors, and for a new name also the descendants that keep theirs.
    const int below = levels(&leaf, used);
    if (levels(used, &leaf) < 0 && !(rename && below > 0 && below <= use->namesBelow_)) continue;
    throw Error(fmt::format("{}: {} is in use: {}", doing, used == &leaf ? "it" : used->path(), use->why_));
  }
}

bool Tree::isFixed(const Leaf& leaf) const {
  const auto folder = [&](const Leaf* l) { return l && (l == classes || l == plugins); };
  return &leaf == root_.get() || folder(&leaf) || folder(leaf.parent_);
}

void Tree::refuseFixed(const Leaf& leaf, const char* verb) const {
  if (isFixed(leaf))
    throw Error(fmt::format("cannot {} {}: it belongs to the kernel (a plugin's classes go when it is unloaded)", verb,
                            leaf.path()));
  if (inUse_ && leaf.linked_) refuseUsed(leaf, false, fmt::format("cannot {} {} now", verb, leaf.path()));
  if (changing_ == 0) return;
  // The leaf or a descendant may be changing.
  const auto walk = [&](const auto& self, const Leaf& l) -> void {
    if (l.changing_)
      throw Error(fmt::format("cannot {} {} now: {} is just being linked or unlinked", verb, leaf.path(),
                              &l == &leaf ? "it" : l.path()));
    if (l.asNode())
      for (const auto& c : l.asNode()->children()) self(self, *c);
  };
  walk(walk, leaf);
}

}  // namespace spark::detail

namespace spark {

InUse::InUse(const Leaf& leaf, std::string_view why, int namesBelow)
    : leaf_(const_cast<Leaf*>(&leaf)),
      why_(why),
      namesBelow_(namesBelow),
      link_(&leaf.kernel().tree().inUse_),
      next_(*link_) {
  *link_ = this;
  if (next_) next_->link_ = &next_;
}

InUse::~InUse() {
  *link_ = next_;
  if (next_) next_->link_ = link_;
}

}  // namespace spark
