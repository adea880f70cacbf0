#include "spark/node.h"

#include <algorithm>
#include <charconv>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark {

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
  if (name.find('/') != std::string::npos) throw Error("cannot name " + path() + " '" + name + "': a name must not hold '/'");
  name_ = std::move(name);
  if (linked_) kernel().changed();
}

Kernel& Leaf::kernel() const { return *class_->kernel_; }

bool Leaf::isLinked() const { return linked_; }

std::string Leaf::path() const {
  if (!parent_) return linked_ ? "/" : name_;
  int same = 0, mine = 0;
  for (const auto& c : parent_->children())
    if (c->name_ == name_) {
      ++same;
      if (c.get() == this) mine = same;
    }
  const std::string above = parent_->path();
  std::string out = above == "/" ? above + name_ : above + "/" + name_;
  if (mine > 1) out += "[" + std::to_string(mine) + "]";
  return out;
}

Leaf* Leaf::find(std::string_view path) const {
  const Leaf* at = this;
  if (!path.empty() && (path.front() == '/' || path.front() == '\\'))
    while (at->parent_) at = at->parent_;
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
    throw Error("expected a " + std::string(id.name) + " at '" + std::string(path) + "' (seen from " + this->path() + "), found nothing." + hint);
  }
  if (void* p = found->query(id)) return p;
  throw Error("expected a " + std::string(id.name) + " at " + found->path() + ", found a " + (found->class_ ? found->class_->name() : "Leaf") +
              ", which lacks interface " + id.name + " version " + std::to_string(id.version) + ".");
}

Node::~Node() {
  for (auto& c : children_) c.reset();
}

Leaf* Node::child(std::string_view name) const {
  int index = 1;
  if (!name.empty() && name.back() == ']') {
    // A literal match wins: names may end in ']'.
    for (const auto& c : children_)
      if (c->name_ == name) return c.get();
    if (const std::size_t open = name.rfind('['); open != std::string_view::npos) {
      const auto r = std::from_chars(name.data() + open + 1, name.data() + name.size() - 1, index);
      if (r.ec != std::errc() || r.ptr != name.data() + name.size() - 1 || index < 1) return nullptr;
      name = name.substr(0, open);
    }
  }
  for (const auto& c : children_)
    if (c->name_ == name && --index == 0) return c.get();
  return nullptr;
}

void Node::throwLacks(const Leaf& leaf, const InterfaceId& id) { Kernel::throwLacks(leaf, id); }

Leaf& Node::add(std::unique_ptr<Leaf> leaf) {
  if (!leaf) throw Error("cannot add nothing to " + path());
  Leaf& added = *leaf;
  if (added.parent_) throw Error("cannot add " + added.path() + " to " + path() + ": it has a parent already");
  if (added.name_.empty() && added.class_) added.name_ = added.class_->name();
  children_.push_back(std::move(leaf));
  added.parent_ = this;
  if (linked_) {
    try {
      link(added);
    } catch (...) {
      if (added.linked_) unlink(added);
      added.parent_ = nullptr;
      children_.erase(std::find_if(children_.begin(), children_.end(), [&](const auto& c) { return c.get() == &added; }));
      throw;
    }
  }
  return added;
}

Leaf& Node::create(std::string_view className, std::string_view name) {
  auto leaf = kernel().classOf(className).create();
  if (!name.empty()) leaf->setName(std::string(name));
  return add(std::move(leaf));
}

void Node::link(Leaf& leaf) {
  Kernel& kernel = leaf.kernel();
  leaf.linked_ = true;
  kernel.changed();
  leaf.onLink();
  kernel.events().hook(leaf);
  if (Node* node = leaf.asNode())
    for (std::size_t i = 0; i < node->children_.size(); ++i)
      if (!node->children_[i]->linked_) link(*node->children_[i]);
}

void Node::unlink(Leaf& leaf) {
  if (Node* node = leaf.asNode())
    for (std::size_t i = 0; i < node->children_.size(); ++i)
      if (node->children_[i]->linked_) unlink(*node->children_[i]);
  leaf.onUnlink();
  Kernel& kernel = leaf.kernel();
  kernel.events().unhook(leaf);
  leaf.linked_ = false;
  kernel.changed();
}

void Node::remove(Leaf& child) {
  const auto it = std::find_if(children_.begin(), children_.end(), [&](const auto& c) { return c.get() == &child; });
  if (it == children_.end()) throw Error("cannot remove " + child.path() + " from " + path() + ": it is no child of it");
  if (child.linked_) unlink(child);
  // onUnlink may have changed the list.
  const auto now = std::find_if(children_.begin(), children_.end(), [&](const auto& c) { return c.get() == &child; });
  std::unique_ptr<Leaf> dying = std::move(*now);
  children_.erase(now);
  if (Node* node = dying->asNode()) node->removeChildren();
}

void Node::removeChildren() {
  while (!children_.empty()) remove(*children_.front());
}

void Node::reparent(Leaf& child, Node& newParent) {
  const auto it = std::find_if(children_.begin(), children_.end(), [&](const auto& c) { return c.get() == &child; });
  if (it == children_.end()) throw Error("cannot move " + child.path() + ": it is no child of " + path());
  for (Node* p = &newParent; p; p = p->parent_)
    if (p == &child) throw Error("cannot move " + child.path() + " below itself");
  std::unique_ptr<Leaf> moving = std::move(*it);
  children_.erase(it);
  child.parent_ = &newParent;
  newParent.children_.push_back(std::move(moving));
  kernel().changed();
  moved(child);
}

void Node::moved(Leaf& leaf) {
  leaf.onMoved();
  if (Node* node = leaf.asNode())
    for (const auto& c : node->children_) moved(*c);
}

}  // namespace spark
