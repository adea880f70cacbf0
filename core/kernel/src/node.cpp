#include "spark/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "spark/describe.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/prefetch.h"
#include "tree.h"

namespace spark {

namespace {
constexpr std::size_t kManyChildren = 64;         // from this number on, children are found by an index of names
constexpr std::size_t kAhead = 8, kVisited = 64;  // prefetching: distance [nodes], bytes of each

/// True for /classes and /plugins, whose children only the kernel adds.
bool isKernelFolder(const Node& node) {
  const detail::Tree& tree = node.kernel().tree();
  return &node == tree.classes || &node == tree.plugins;
}
}  // namespace

void Node::describe(Description<Node>& d) {
  d.doc("An element that owns children.");
  d.method("unlinkChildren", &Node::removeChildren).doc("Removes all children, first to last.");
}

std::size_t Node::ordinalOf(const Leaf& child) const {
  if (names_) {
    const auto same = names_->find(child.name());
    if (same != names_->end()) {
      const std::vector<Leaf*>& list = same->second;
      if (list.back() == &child) return list.size();  // a child that was just added
      return std::find(list.begin(), list.end(), &child) - list.begin() + 1;
    }
  }
  std::size_t n = 1;
  for (const auto& c : children_) {
    if (c.get() == &child) return n;
    if (c->name() == child.name()) ++n;
  }
  return 1;
}

/// Adds a new child to the index of names. Makes the index if there are many children.
void Node::rememberName(Leaf& child) {
  if (names_) {
    (*names_)[child.name()].push_back(&child);
  } else if (children_.size() >= kManyChildren) {
    names_ = std::make_unique<Names>();
    for (const auto& c : children_) (*names_)[c->name()].push_back(c.get());
  }
}

Node::~Node() {
  // The list is emptied first, because the destructor of a child may read it.
  forgetNames();
  const std::vector<std::unique_ptr<Leaf>> dying = std::move(children_);
  children_.clear();
}

Leaf* Node::child(std::string_view name) const {
  std::uint32_t ordinal = 1;
  if (!name.empty() && name.back() == ']') {
    // A name may itself end in ']'.
    if (Leaf* literal = numbered(name, 1)) return literal;
    if (const std::size_t open = name.rfind('['); open != std::string_view::npos) {
      const char* end = name.data() + name.size() - 1;
      const auto r = std::from_chars(name.data() + open + 1, end, ordinal);
      if (r.ec != std::errc() || r.ptr != end || ordinal < 1) return nullptr;
      name = name.substr(0, open);
    }
  }
  return numbered(name, ordinal);
}

/// The n-th child of that name, from 1; nullptr if there is none.
Leaf* Node::numbered(std::string_view name, std::size_t n) const {
  if (names_) {
    const auto same = names_->find(name);
    return same != names_->end() && n <= same->second.size() ? same->second[n - 1] : nullptr;
  }
  for (const auto& c : children_)
    if (c->name() == name && --n == 0) return c.get();
  return nullptr;
}

void Node::walk(const InterfaceId& id, bool deep, Take take, void* list) const {
  for (const auto& c : children_) {
    void* match = c->query(id);
    if (match) take(list, match, *c);
    if (Node* node = !match || deep ? c->asNode() : nullptr) node->walk(id, deep, take, list);
  }
}

void Node::collectAs(const InterfaceId& id, bool deep, Take take, void* list) const {
  if (!isLinked() || !kernel().tree().isOrdered()) return walk(id, deep, take, list);
  // In the kernel's list all descendants follow their ancestor.
  const std::vector<Leaf*>& order = kernel().tree().order();
  for (std::size_t i = detail::Tree::preOrder(*this) + 1; i <= detail::Tree::lastBelow(*this); ++i) {
    if (i + kAhead < order.size()) prefetch(order[i + kAhead], kVisited);
    void* match = order[i]->query(id);
    if (!match) continue;
    take(list, match, *order[i]);
    if (!deep) i = detail::Tree::lastBelow(*order[i]);
  }
}

Leaf& Node::add(std::unique_ptr<Leaf> leaf) {
  if (!leaf) throw Error(fmt::format("cannot add nothing to {}", path()));
  Leaf& added = *leaf;
  if (!added.classObject())
    throw Error(fmt::format("cannot add an object without a class to {}: make it through its class object", path()));
  const auto refuse = [&](const char* why) {
    throw Error(fmt::format("cannot add {} to {}: {}", added.path(), path(), why));
  };
  if (added.parent() || added.isLinked()) refuse("it has a parent already");
  if (classObject() && &kernel() != &added.kernel()) refuse("it was made by another kernel");
  if (classObject() && isKernelFolder(*this)) refuse("what is there comes from plugins");
  return added.kernel().tree().attach(*this, std::move(leaf));
}

Leaf& Node::create(std::string_view className, std::string_view name) {
  auto leaf = kernel().classOf(className).create();
  if (!name.empty()) leaf->setName(std::string(name));
  return add(std::move(leaf));
}

void Node::remove(Leaf& child) {
  if (child.parent() != this)
    throw Error(fmt::format("cannot remove {} from {}: it is no child of it", child.path(), path()));
  kernel().tree().refuseFixed(child, "remove");
  kernel().tree().detach(child);
}

void Node::removeChildren() {
  // Check all children first, so that either all or none are removed.
  for (const auto& c : children_) kernel().tree().refuseFixed(*c, "remove");
  while (!children_.empty()) remove(*children_.front());
}

void Node::reparent(Leaf& child, Node& newParent) {
  if (child.parent() != this) throw Error(fmt::format("cannot move {}: it is no child of {}", child.path(), path()));
  for (Node* p = &newParent; p; p = p->parent())
    if (p == &child) throw Error(fmt::format("cannot move {} below itself", child.path()));
  kernel().tree().refuseFixed(child, "move");
  if (&newParent.kernel() != &kernel())
    throw Error(fmt::format("cannot move {} to {}, which belongs to another kernel", child.path(), newParent.path()));
  if (isKernelFolder(newParent))
    throw Error(fmt::format("cannot move {} to {}: what is there comes from plugins", child.path(), newParent.path()));
  kernel().tree().move(child, newParent);
}

}  // namespace spark
