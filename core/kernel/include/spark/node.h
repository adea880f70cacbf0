#pragma once
/// \file
/// A Leaf that owns children.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "spark/abi/spark/node.h"
#include "spark/leaf.h"

namespace spark {

/// A Leaf that owns children, in order.
class Node : public Leaf {
 public:
  static constexpr const char* kClassName = "Node";
  using ClassSelf = Node;
  using ClassBase = Leaf;
  static constexpr InterfaceId kInterface{"Node", 1};
  static void describe(Description<Node>& d);

  ~Node() override;
  Node* asNode() override { return this; }

  /// The children in order; owned by this node, valid until the tree changes.
  const std::vector<std::unique_ptr<Leaf>>& children() const { return children_; }
  /// The kernel's structureVersion() when somebody came, went, or got another name below this node last: who looks only
  /// at what is below looks again when this grew.
  std::uint64_t changedAt() const { return changedAt_; }
  /// The first child of that name, nullptr when there is none. Takes `name[k]`.
  Leaf* child(std::string_view name) const;
  /// The k of a child's `name[k]`: from 1, among the children of its name.
  std::size_t ordinalOf(const Leaf& child) const;
  /// The tree is no deeper than this.
  static constexpr int kMostLevels = 1000;
  /// Appends and links. Throws what onLink throws; the tree is then as before.
  Leaf& add(std::unique_ptr<Leaf> leaf);
  /// Makes an object of the named class, names it (unless `name` is empty) and adds it. Throws Error.
  Leaf& create(std::string_view className, std::string_view name = {});
  /// Makes an object and returns it as T. Throws Error when the class has no such interface.
  template <class T>
  T& create(std::string_view className, std::string_view name = {}) {
    return *static_cast<T*>(create(className, name).requireAs(T::kInterface));
  }
  /// Unlinks and destroys a child with all below it. References to them are empty before the first destructor runs.
  /// Throws Error for what is being linked or unlinked at that moment or in use (InUse), and for classes and plugins
  /// (unload the plugin).
  void remove(Leaf& child);
  /// Unlinks and destroys all children, first to last. Throws as `remove`.
  void removeChildren();
  /// Moves a child to another parent (appended) without destroying anything; onMoved runs for all that moved (between
  /// linked parents; else they are linked or unlinked). Throws what onMoved and onLink throw; the child is then back,
  /// as the last one.
  void reparent(Leaf& child, Node& newParent);
  /// All descendants that are a T, depth first, in child order; `deep` false: do not look below a match. Costs little
  /// where the kernel's order is up to date (Kernel::updateOrder), a walk elsewhere.
  template <class T>
  void collect(std::vector<T*>& out, bool deep = true) const {
    collectAs(
        T::kInterface, deep,
        [](void* list, void* match, Leaf&) { static_cast<std::vector<T*>*>(list)->push_back(static_cast<T*>(match)); },
        &out);
  }
  /// As `collect` where only the id of T is known: calls take(list, object as T, leaf) for each.
  using Take = void (*)(void* list, void* object, Leaf& leaf);
  void collectAs(const InterfaceId& id, bool deep, Take take, void* list) const;
  /// The first child that is a T, nullptr when there is none.
  template <class T>
  T* childOf() const {
    for (const auto& c : children_)
      if (T* match = c->as<T>()) return match;
    return nullptr;
  }

 private:
  friend class detail::Tree;
  void walk(const InterfaceId& id, bool deep, Take take, void* list) const;
  /// Children of one name, in order.
  using Names = std::unordered_map<std::string_view, std::vector<Leaf*>>;
  void rememberName(Leaf& child);
  Leaf* numbered(std::string_view name, std::size_t n) const;
  /// To be called before children go, move or get other names.
  void forgetNames() { names_.reset(); }

  std::vector<std::unique_ptr<Leaf>> children_;
  std::unique_ptr<Names> names_;  ///< of all children, when there are many and all came one after the other; else empty
  std::uint64_t changedAt_ = 0;
};

template <class T>
T* Leaf::ancestor() const {
  for (Leaf* p = parent_; p; p = p->parent_)
    if (T* match = p->as<T>()) return match;
  return nullptr;
}

}  // namespace spark
