#include "spark/leaf.h"

#include <fmt/format.h>

#include <algorithm>

#include "class_registry.h"
#include "spark/describe.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "tree.h"

namespace spark {

Leaf::~Leaf() {
  if (life_) {
    life_->leaf = nullptr;
    if (--life_->references == 0) delete life_;
  }
  if (class_) --class_->living_;
}

detail::Life* detail::shareLife(const Leaf& leaf) {
  if (!leaf.life_) leaf.life_ = new Life{const_cast<Leaf*>(&leaf), 1};
  ++leaf.life_->references;
  return leaf.life_;
}

void Leaf::describe(Description<Leaf>& d) {
  d.doc("A named element of the tree.");
  d.property("name", &Leaf::name, &Leaf::setName).doc("The name below its parent.");
  d.method("getFullPath", &Leaf::path).doc("The path from the root.");
  d.method("isLeaf", &Leaf::isLeaf).doc("True when it cannot have children.");
  d.method("unlinkLeaf", &Leaf::unlinkLeaf).doc("Removes it, with all below it, from its parent.");
}

void Leaf::unlinkLeaf() {
  if (parent_) parent_->remove(*this);
}

void Leaf::setName(std::string name) {
  const auto refuse = [&](const char* why) { throw Error(fmt::format("cannot name {} '{}': {}", path(), name, why)); };
  if (name.find_first_of("/\\") != std::string::npos)
    refuse("a name must not hold '/' or '\\', which separate names in paths");
  if (name == "." || name == "..") refuse("'.' and '..' have a meaning in paths");
  if (name.empty() && parent_) refuse("what has a parent needs a name");
  if (linked_ && kernel().tree().isFixed(*this)) refuse("classes, plugins and their folders keep their names");
  if (linked_ && name != name_)
    kernel().tree().refuseUsed(*this, true, fmt::format("cannot name {} '{}' now", path(), name));
  detail::Tree::rename(*this, std::move(name));
}

Kernel& Leaf::kernel() const {
  if (!class_)
    throw Error(
        "kernel() is not there in a constructor, nor is the tree: do this in onLink(), which runs when the object "
        "hangs in the tree");
  return class_->kernel_;
}

bool Leaf::isLinked() const { return linked_; }

std::string Leaf::path() const {
  if (!parent_) return linked_ ? "/" : name_;
  // Collect the ancestors from this object upwards, then write their names from the top downwards.
  std::vector<const Leaf*> ancestors;
  const Leaf* top = this;
  for (; top->parent_; top = top->parent_) ancestors.push_back(top);
  std::string out = top->linked_ ? "" : top->name_;
  for (std::size_t i = ancestors.size(); i-- > 0;) {
    const Leaf& leaf = *ancestors[i];
    out.append("/").append(leaf.name_);
    if (const std::size_t ordinal = leaf.parent_->ordinalOf(leaf); ordinal > 1) out += fmt::format("[{}]", ordinal);
  }
  return out;
}

Leaf* Leaf::find(std::string_view path) const {
  const Leaf* at = this;
  if (!path.empty() && (path.front() == '/' || path.front() == '\\')) {
    // An absolute path begins at the root of the object's kernel, even if the object is not linked.
    if (class_ && class_->kernel_.tree().root()) at = class_->kernel_.tree().root();
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

void* Leaf::requireAs(const InterfaceId& id) const {
  if (void* p = query(id)) return p;
  throw Error(fmt::format("expected a {0}, found {1} of class {2}, which lacks interface {0} version {3}", id.name,
                          path(), class_ ? class_->name() : "Leaf", id.version));
}

void* Leaf::requireInterface(std::string_view path, const InterfaceId& id) const {
  const Leaf* found = find(path);
  if (!found) {
    // Follow the path to its first missing name, and suggest the nearest ones there.
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
        hint = fmt::format(" There is no '{}' in {}.{}", part, at->path(), didYouMean(part, names));
        break;
      }
      at = next;
      rest.remove_prefix(std::min(n + 1, rest.size()));
    }
    throw Error(
        fmt::format("expected a {} at '{}' (seen from {}), found nothing.{}", id.name, path, this->path(), hint));
  }
  if (void* p = found->query(id)) return p;
  throw Error(fmt::format("expected a {0} at {1}, found a {2}, which lacks interface {0} version {3}.", id.name,
                          found->path(), found->class_ ? found->class_->name() : "Leaf", id.version));
}

}  // namespace spark
