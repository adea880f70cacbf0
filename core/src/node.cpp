#include "spark/node.h"

#include <algorithm>
#include <charconv>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/running.h"

// How a node joins and leaves. link: onLink of the parent, its hooks, then its children's; when one throws, what was
// linked is unlinked again and add() throws. unlink: children first, then onUnlink, then its handlers go. Both may
// change the tree around them, so lists are walked by index and looked at again; only what is on its way in or out
// itself must stay where it is (`changing_`). Once all is unlinked references turn empty, then destructors run: none
// sees another object half destroyed.

namespace spark {

namespace {
constexpr std::size_t kManyChildren = 64;
}

/// Marks a leaf as on its way.
struct Node::Changing {
  explicit Changing(Leaf& l) : leaf(l), before(l.changing_) {
    leaf.changing_ = true;
    ++leaf.kernel().changing_;
  }
  ~Changing() {
    leaf.changing_ = before;
    --leaf.kernel().changing_;
  }
  Changing(const Changing&) = delete;
  Changing& operator=(const Changing&) = delete;
  Leaf& leaf;
  bool before;
};

InUse::InUse(const Leaf& leaf, std::string_view why, int namesBelow)
    : leaf_(const_cast<Leaf*>(&leaf)), why_(why), namesBelow_(namesBelow), link_(&leaf.kernel().inUse_), next_(*link_) {
  *link_ = this;
  if (next_) next_->link_ = &next_;
}

InUse::~InUse() {
  *link_ = next_;
  if (next_) next_->link_ = link_;
}

void Kernel::refuseUsed(const Leaf& leaf, bool rename, const std::string& doing) {
  // How many levels `low` is below `high`, -1 when it is not below it.
  const auto levels = [](const Leaf* low, const Leaf* high) {
    for (int n = 0; low; low = low->parent(), ++n)
      if (low == high) return n;
    return -1;
  };
  for (const InUse* use = leaf.kernel().inUse_; use; use = use->next_) {
    const Leaf* used = use->leaf_.get();
    if (!used) continue;
    const int below = levels(&leaf, used);
    if (levels(used, &leaf) < 0 && !(rename && below > 0 && below <= use->namesBelow_)) continue;
    throw Error(doing + ": " + (used == &leaf ? "it" : used->path()) + " is in use: " + std::string(use->why_));
  }
}

Leaf::~Leaf() {
  if (life_) {
    life_->leaf = nullptr;
    if (--life_->references == 0) delete life_;
  }
  if (class_) --class_->living_;
}

detail::Life* Leaf::life() const {
  if (!life_) life_ = new detail::Life{const_cast<Leaf*>(this), 1};
  return life_;
}

void Leaf::setName(std::string name) {
  const auto refuse = [&](const char* why) { throw Error("cannot name " + path() + " '" + name + "': " + why); };
  if (name.find_first_of("/\\") != std::string::npos)
    refuse("a name must not hold '/' or '\\', which separate names in paths");
  if (name == "." || name == "..") refuse("'.' and '..' have a meaning in paths");
  if (name.empty() && parent_) refuse("what has a parent needs a name");
  if (linked_ && Node::isFixed(*this)) refuse("classes, plugins and their folders keep their names");
  if (linked_ && name != name_) Kernel::refuseUsed(*this, true, "cannot name " + path() + " '" + name + "' now");
  if (parent_) parent_->forgetNames();
  name_ = std::move(name);
  if (linked_) kernel().changed(parent_);
}

Kernel& Leaf::kernel() const {
  if (!class_)
    throw Error(
        "kernel() is not there in a constructor, nor is the tree: do this in onLink(), which runs when the object "
        "hangs in the tree");
  return *class_->kernel_;
}

bool Leaf::isLinked() const { return linked_; }

std::string Leaf::path() const {
  if (!parent_) return linked_ ? "/" : name_;
  std::vector<const Leaf*> way;
  const Leaf* top = this;
  for (; top->parent_; top = top->parent_) way.push_back(top);
  std::string out = top->linked_ ? "" : top->name_;
  for (std::size_t i = way.size(); i-- > 0;) {
    out += "/" + way[i]->name_;
    if (const std::size_t mine = way[i]->parent_->ordinal(*way[i]); mine > 1) out += "[" + std::to_string(mine) + "]";
  }
  return out;
}

/// From 1, among the children of its name.
std::size_t Node::ordinal(const Leaf& child) const {
  if (names_) {
    const auto same = names_->find(child.name_);
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
    if (c->name_ == child.name_) ++n;
  }
  return 1;
}

/// Called for every new child: from kManyChildren on they are found without looking at all of them.
void Node::rememberName(Leaf& child) {
  if (names_) {
    (*names_)[child.name_].push_back(&child);
  } else if (children_.size() >= kManyChildren) {
    names_ = std::make_unique<Names>();
    for (const auto& c : children_) (*names_)[c->name_].push_back(c.get());
  }
}

Leaf* Leaf::find(std::string_view path) const {
  const Leaf* at = this;
  if (!path.empty() && (path.front() == '/' || path.front() == '\\')) {
    // What is not linked knows its kernel all the same.
    if (class_ && class_->kernel_->root_) at = class_->kernel_->root_.get();
    while (at->parent_) at = at->parent_;
  }
  while (!path.empty()) {
    const std::size_t n = std::min(path.find_first_of("/\\"), path.size());
    const std::string_view part = path.substr(0, n);
    path.remove_prefix(std::min(n + 1, path.size()));
    if (part.empty() || part == ".") continue;
    if (part == "..") {
      at = at->parent_;
    } else {
      const Node* node = at->asNode();
      at = node ? node->child(part) : nullptr;
    }
    if (!at) return nullptr;
  }
  return const_cast<Leaf*>(at);
}

void* Leaf::query(const InterfaceId& id) const {
  Leaf* self = const_cast<Leaf*>(this);
  if (id.id == Leaf::kInterface.id) return self;
  if (id.id == Node::kInterface.id) return self->asNode();
  return class_ ? class_->cast(self, id) : nullptr;
}

void* Leaf::requireInterface(std::string_view path, const InterfaceId& id) const {
  const Leaf* found = find(path);
  if (!found) {
    // Walk as far as the path goes, to say what is missing there and what is near.
    std::string_view rest = path;
    const Leaf* at = this;
    if (!rest.empty() && rest.front() == '/') at = find("/");
    std::string hint;
    while (!rest.empty()) {
      const std::size_t n = std::min(rest.find('/'), rest.size());
      const std::string_view part = rest.substr(0, n);
      const Leaf* next = part.empty() ? at : at->find(part);
      if (!next) {
        std::vector<std::string> names;
        if (at->asNode())
          for (const auto& c : at->asNode()->children()) names.push_back(c->name());
        hint = " There is no '" + std::string(part) + "' in " + at->path() + "." + didYouMean(part, names);
        break;
      }
      at = next;
      rest.remove_prefix(std::min(n + 1, rest.size()));
    }
    throw Error("expected a " + std::string(id.name) + " at '" + std::string(path) + "' (seen from " + this->path() +
                "), found nothing." + hint);
  }
  if (void* p = found->query(id)) return p;
  throw Error("expected a " + std::string(id.name) + " at " + found->path() + ", found a " +
              (found->class_ ? found->class_->name() : "Leaf") + ", which lacks interface " + id.name + " version " +
              std::to_string(id.version) + ".");
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
    if (c->name_ == name && --n == 0) return c.get();
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
  if (!linked_ || kernel().orderedAt_ != kernel().structureVersion()) return walk(id, deep, take, list);
  const std::vector<Leaf*>& order = kernel().order_;
  for (std::size_t i = preOrder_ + 1; i <= lastBelow_; ++i) {
    void* match = order[i]->query(id);
    if (!match) continue;
    take(list, match, *order[i]);
    if (!deep) i = order[i]->lastBelow_;
  }
}

void Node::throwLacks(const Leaf& leaf, const InterfaceId& id) { Kernel::throwLacks(leaf, id); }

bool Node::isFixed(const Leaf& leaf) {
  const Kernel& kernel = leaf.kernel();
  const auto folder = [&](const Leaf* l) { return l && (l == kernel.classesNode_ || l == kernel.pluginsNode_); };
  return &leaf == kernel.root_.get() || folder(&leaf) || folder(leaf.parent_);
}

void Node::mustRest(const Leaf& leaf, const char* verb) {
  if (isFixed(leaf))
    throw Error("cannot " + std::string(verb) + " " + leaf.path() +
                ": it belongs to the kernel (a plugin's classes go when it is unloaded)");
  if (leaf.kernel().inUse_ && leaf.linked_)
    Kernel::refuseUsed(leaf, false, "cannot " + std::string(verb) + " " + leaf.path() + " now");
  if (leaf.kernel().changing_ == 0) return;
  const auto walk = [&](const auto& self, const Leaf& l) -> void {
    if (l.changing_)
      throw Error("cannot " + std::string(verb) + " " + leaf.path() + " now: " + (&l == &leaf ? "it" : l.path()) +
                  " is just being linked or unlinked");
    if (l.asNode())
      for (const auto& c : l.asNode()->children_) self(self, *c);
  };
  walk(walk, leaf);
}

std::size_t Node::indexOf(const Leaf& child) const {
  return static_cast<std::size_t>(
      std::find_if(children_.begin(), children_.end(), [&](const auto& c) { return c.get() == &child; }) -
      children_.begin());
}

Leaf& Node::add(std::unique_ptr<Leaf> leaf) {
  if (!leaf) throw Error("cannot add nothing to " + path());
  Leaf& added = *leaf;
  if (!added.class_)
    throw Error("cannot add an object without a class to " + path() + ": make it through its class object");
  if (added.parent_ || added.linked_)
    throw Error("cannot add " + added.path() + " to " + path() + ": it has a parent already");
  if (class_ && class_->kernel_ != added.class_->kernel_)
    throw Error("cannot add " + added.path() + " to " + path() + ": it was made by another kernel");
  if (class_ && (this == kernel().classesNode_ || this == kernel().pluginsNode_))
    throw Error("cannot add " + added.path() + " to " + path() + ": what is there comes from plugins");
  return attach(std::move(leaf));
}

Leaf& Node::attach(std::unique_ptr<Leaf> leaf) {
  Leaf& added = *leaf;
  int levels = 1;
  for (const Node* up = parent_; up; up = up->parent_) ++levels;
  if (levels > kMostLevels)
    throw Error("cannot add a " + added.class_->name() + " here: the tree is at most " + std::to_string(kMostLevels) +
                " levels deep");
  if (added.name_.empty()) added.name_ = added.class_->name();
  children_.push_back(std::move(leaf));
  added.parent_ = this;
  rememberName(added);
  if (!linked_) return added;
  try {
    link(added);
  } catch (...) {
    bury(added);
    forgetNames();
    const std::size_t i = indexOf(added);
    const std::unique_ptr<Leaf> dying = std::move(children_[i]);
    children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(i));
    throw;
  }
  return added;
}

Leaf& Node::create(std::string_view className, std::string_view name) {
  auto leaf = kernel().classOf(className).create();
  if (!name.empty()) leaf->setName(std::string(name));
  return add(std::move(leaf));
}

void Node::linkChildren(Node& node) {
  for (std::size_t i = 0; i < node.children_.size();) {
    Leaf& child = *node.children_[i];
    if (!child.linked_) link(child);
    i = i < node.children_.size() && node.children_[i].get() == &child ? i + 1 : 0;
  }
}

void Node::unlinkChildren(Leaf& leaf) {
  Node* node = leaf.asNode();
  if (!node) return;
  for (std::size_t i = 0; i < node->children_.size();) {
    Leaf& child = *node->children_[i];
    if (child.linked_) unlink(child);
    i = i < node->children_.size() && node->children_[i].get() == &child ? i + 1 : 0;
  }
}

void Node::link(Leaf& leaf) {
  Kernel& kernel = leaf.kernel();
  const Changing guard(leaf);
  leaf.linked_ = true;
  kernel.changed(leaf.parent_);
  bool entered = false;
  try {
    {
      const NowRunning now("onLink", &leaf);
      leaf.onLink();
    }
    entered = true;
    kernel.events().hook(leaf);
    if (Node* node = leaf.asNode()) linkChildren(*node);
    leaf.class_->warnOfMissing(leaf);
  } catch (...) {
    unlinkChildren(leaf);
    if (entered) leave(leaf);
    kernel.events().unhook(leaf);
    leaf.linked_ = false;
    kernel.changed(leaf.parent_);
    throw;
  }
}

void Node::leave(Leaf& leaf) {
  const NowRunning now("onUnlink", &leaf);
  try {
    leaf.onUnlink();
  } catch (const std::exception& e) {
    leaf.kernel().log().error("{} (class {}) failed to leave the tree: {}", leaf.path(), leaf.class_->name(), e.what());
  }
}

void Node::unlink(Leaf& leaf) {
  const Changing guard(leaf);
  unlinkChildren(leaf);
  leave(leaf);
  unlinkChildren(leaf);  // what onUnlink made
  Kernel& kernel = leaf.kernel();
  kernel.events().unhook(leaf);
  leaf.linked_ = false;
  kernel.changed(leaf.parent_);
}

void Node::bury(Leaf& leaf) {
  if (leaf.life_) leaf.life_->leaf = nullptr;
  if (Node* node = leaf.asNode())
    for (const auto& c : node->children_) bury(*c);
}

void Node::remove(Leaf& child) {
  if (child.parent_ != this)
    throw Error("cannot remove " + child.path() + " from " + path() + ": it is no child of it");
  mustRest(child, "remove");
  detach(child);
}

void Node::detach(Leaf& child) {
  if (child.linked_) unlink(child);
  bury(child);
  forgetNames();
  const std::size_t i = indexOf(child);
  const std::unique_ptr<Leaf> dying = std::move(children_[i]);
  children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(i));
  if (Node* node = dying->asNode()) destroyBelow(*node);
}

/// First to last, what is below before what is above. All is unlinked and buried.
void Node::destroyBelow(Node& node) {
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

void Node::removeChildren() {
  for (const auto& c : children_) mustRest(*c, "remove");
  while (!children_.empty()) remove(*children_.front());
}

void Node::reparent(Leaf& child, Node& newParent) {
  if (child.parent_ != this) throw Error("cannot move " + child.path() + ": it is no child of " + path());
  for (Node* p = &newParent; p; p = p->parent_)
    if (p == &child) throw Error("cannot move " + child.path() + " below itself");
  mustRest(child, "move");
  if (&newParent.kernel() != &kernel())
    throw Error("cannot move " + child.path() + " to " + newParent.path() + ", which belongs to another kernel");
  if (&newParent == kernel().classesNode_ || &newParent == kernel().pluginsNode_)
    throw Error("cannot move " + child.path() + " to " + newParent.path() + ": what is there comes from plugins");
  if (child.linked_ && !newParent.linked_) unlink(child);
  const auto carry = [&](Node& from, Node& to) {
    to.children_.reserve(to.children_.size() + 1);
    from.forgetNames();
    to.forgetNames();
    const std::size_t i = from.indexOf(child);
    std::unique_ptr<Leaf> moving = std::move(from.children_[i]);
    from.children_.erase(from.children_.begin() + static_cast<std::ptrdiff_t>(i));
    child.parent_ = &to;
    to.children_.push_back(std::move(moving));
    to.kernel().changed(&from);
    to.kernel().changed(&to);
  };
  carry(*this, newParent);
  try {
    if (child.linked_ == newParent.linked_)
      moved(child);
    else
      link(child);
  } catch (...) {
    carry(newParent, *this);
    try {
      if (child.linked_) moved(child);
    } catch (const std::exception& e) {
      kernel().log().error("{} could not be moved, nor back: {}", child.path(), e.what());
    }
    throw;
  }
}

void Node::moved(Leaf& leaf) {
  const Changing guard(leaf);
  {
    const NowRunning now("onMoved", &leaf);
    leaf.onMoved();
  }
  leaf.class_->warnOfMissing(leaf);
  if (Node* node = leaf.asNode())
    for (std::size_t i = 0; i < node->children_.size(); ++i) moved(*node->children_[i]);
}

}  // namespace spark
