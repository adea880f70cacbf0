#include "spark/node.h"

#include <algorithm>
#include <charconv>

#include "spark/describe.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "tree.h"

namespace spark {

namespace {
constexpr std::size_t kManyChildren = 64;

/// Only the kernel adds children to it.
bool isKernels(const Node& node) {
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
      if (same->second.back() == &child) return same->second.size();
      return static_cast<std::size_t>(std::find(same->second.begin(), same->second.end(), &child) -
                                      same->second.begin()) +
             1;
    }
  }
  std::size_t n = 1;
  for (const auto& c : children_) {
    if (c.get() == &child) return n;
    if (c->name() == child.name()) ++n;
  }
  return 1;
}

/// Called for every new child: from kManyChildren on they are found without looking at all of them.
void Node::rememberName(Leaf& child) {
  if (names_) {
    (*names_)[child.name()].push_back(&child);
  } else if (children_.size() >= kManyChildren) {
    names_ = std::make_unique<Names>();
    for (const auto& c : children_) (*names_)[c->name()].push_back(c.get());
  }
}

Node::~Node() {
  // Away from the list first: a child's destructor may look at its siblings.
  forgetNames();
  const std::vector<std::unique_ptr<Leaf>> dying = std::move(children_);
  children_.clear();
}

Leaf* Node::child(std::string_view name) const {
  int index = 1;
  if (!name.empty() && name.back() == ']') {
    // A literal match wins: names may end in ']'.
    if (Leaf* literal = numbered(name, 1)) return literal;
    if (const std::size_t open = name.rfind('['); open != std::string_view::npos) {
      const auto r = std::from_chars(name.data() + open + 1, name.data() + name.size() - 1, index);
      if (r.ec != std::errc() || r.ptr != name.data() + name.size() - 1 || index < 1) return nullptr;
      name = name.substr(0, open);
    }
  }
  return numbered(name, static_cast<std::size_t>(index));
}

/// The n-th child of that name, from 1.
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

/// In the flat order the descendants are one range.
void Node::collectAs(const InterfaceId& id, bool deep, Take take, void* list) const {
  if (!isLinked() || !kernel().tree().isOrdered()) return walk(id, deep, take, list);
  const std::vector<Leaf*>& order = kernel().tree().order();
  for (std::size_t i = detail::Tree::preOrder(*this) + 1; i <= detail::Tree::lastBelow(*this); ++i) {
    void* match = order[i]->query(id);
    if (!match) continue;
    take(list, match, *order[i]);
    if (!deep) i = detail::Tree::lastBelow(*order[i]);
  }
}

Leaf& Node::add(std::unique_ptr<Leaf> leaf) {
  if (!leaf) throw Error("cannot add nothing to " + path());
  Leaf& added = *leaf;
  if (!added.classObject())
    throw Error("cannot add an object without a class to " + path() + ": make it through its class object");
  if (added.parent() || added.isLinked())
    throw Error("cannot add " + added.path() + " to " + path() + ": it has a parent already");
  if (classObject() && &kernel() != &added.kernel())
    throw Error("cannot add " + added.path() + " to " + path() + ": it was made by another kernel");
  if (classObject() && isKernels(*this))
    throw Error("cannot add " + added.path() + " to " + path() + ": what is there comes from plugins");
  return added.kernel().tree().attach(*this, std::move(leaf));
}

Leaf& Node::create(std::string_view className, std::string_view name) {
  auto leaf = kernel().classOf(className).create();
  if (!name.empty()) leaf->setName(std::string(name));
  return add(std::move(leaf));
}

void Node::remove(Leaf& child) {
  if (child.parent() != this)
    throw Error("cannot remove " + child.path() + " from " + path() + ": it is no child of it");
  kernel().tree().refuseFixed(child, "remove");
  kernel().tree().detach(child);
}

void Node::removeChildren() {
  for (const auto& c : children_) kernel().tree().refuseFixed(*c, "remove");
  while (!children_.empty()) remove(*children_.front());
}

void Node::reparent(Leaf& child, Node& newParent) {
  if (child.parent() != this) throw Error("cannot move " + child.path() + ": it is no child of " + path());
  for (Node* p = &newParent; p; p = p->parent())
    if (p == &child) throw Error("cannot move " + child.path() + " below itself");
  kernel().tree().refuseFixed(child, "move");
  if (&newParent.kernel() != &kernel())
    throw Error("cannot move " + child.path() + " to " + newParent.path() + ", which belongs to another kernel");
  if (isKernels(newParent))
    throw Error("cannot move " + child.path() + " to " + newParent.path() + ": what is there comes from plugins");
  kernel().tree().move(child, newParent);
}

}  // namespace spark
