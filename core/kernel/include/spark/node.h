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

/// A Leaf that owns children, in the order in which they were added.
class Node : public Leaf {
  SPARK_CLASS(Node, Leaf)

 public:
  /// Describes the class.
  static void describe(Description<Node>& d);

  /// Destroys all children.
  ~Node() override;
  Node* asNode() override { return this; }

  /// The children in order. Owned by this node; the list is valid until the tree changes.
  const std::vector<std::unique_ptr<Leaf>>& children() const { return children_; }
  /// The kernel's structureVersion() at the last change below this node: an object was added, removed, moved or
  /// renamed. A cache of descendants is valid while this number is unchanged.
  std::uint64_t changedAt() const { return changedAt_; }
  /// The first child of that name, or the k-th for `name[k]`; nullptr if there is none.
  Leaf* child(std::string_view name) const;
  /// The k in `name[k]` of a child: its position among the children of the same name, from 1.
  std::size_t ordinalOf(const Leaf& child) const;
  /// The maximum depth of a tree.
  static constexpr int kMostLevels = 1000;
  /// Appends an object to the children, and links it if this node is linked. Throws Error if the object has a parent or
  /// another kernel, and what onLink() throws; the object is then destroyed and the tree as before.
  Leaf& add(std::unique_ptr<Leaf> leaf);
  /// Makes an object of a class, names it (an empty `name` leaves the class name) and adds it. Throws Error if there is
  /// no such class, and as add().
  Leaf& create(std::string_view className, std::string_view name = {});
  /// As above, and returns the object as T. Throws Error also if the object is not a T.
  template <class T>
  T& create(std::string_view className, std::string_view name = {}) {
    return *static_cast<T*>(create(className, name).requireAs(T::kInterface));
  }
  /// Unlinks and destroys a child with all its descendants. References to them are empty before the first destructor
  /// runs. Throws Error for an object that is being linked or unlinked now or is in use (InUse), and for classes and
  /// plugins (Loader::unload removes them).
  void remove(Leaf& child);
  /// Unlinks and destroys all children, first to last. Throws as remove().
  void removeChildren();
  /// Moves a child to the end of another parent's children. If both parents are linked, onMoved() runs for the child
  /// and its descendants; else they are linked or unlinked. Throws as remove(), and what onMoved() and onLink() throw;
  /// the child then is the last one of its old parent.
  void reparent(Leaf& child, Node& newParent);
  /// Appends all descendants that are a T to `out`, depth first in the order of children. `deep` false: descendants of
  /// a match are skipped. Reads a flat list if the kernel's order is up to date (Kernel::updateOrder), else walks the
  /// tree.
  template <class T>
  void collect(std::vector<T*>& out, bool deep = true) const {
    collectAs(
        T::kInterface, deep,
        [](void* list, void* match, Leaf&) { static_cast<std::vector<T*>*>(list)->push_back(static_cast<T*>(match)); },
        &out);
  }
  /// Receives a match: the `list` that was passed to collectAs(), the object as T, and its leaf.
  using Take = void (*)(void* list, void* object, Leaf& leaf);
  /// As collect(), for a T of which only the id is known. Calls take(list, object, leaf) for each match.
  void collectAs(const InterfaceId& id, bool deep, Take take, void* list) const;
  /// The first child that is a T; nullptr if there is none.
  template <class T>
  T* childOf() const {
    for (const auto& c : children_)
      if (T* match = c->as<T>()) return match;
    return nullptr;
  }

 private:
  friend class detail::Tree;
  void walk(const InterfaceId& id, bool deep, Take take, void* list) const;
  /// The children of each name, in order.
  using Names = std::unordered_map<std::string_view, std::vector<Leaf*>>;
  void rememberName(Leaf& child);
  Leaf* numbered(std::string_view name, std::size_t n) const;
  /// Drops the index. Must be called before children leave, move or are renamed.
  void forgetNames() { names_.reset(); }

  std::vector<std::unique_ptr<Leaf>> children_;
  std::unique_ptr<Names> names_;  ///< index of many children; nullptr for few, and after a change until the next add
  std::uint64_t changedAt_ = 0;
};

template <class T>
T* Leaf::ancestor() const {
  for (Leaf* p = parent_; p; p = p->parent_)
    if (T* match = p->as<T>()) return match;
  return nullptr;
}

}  // namespace spark
