#pragma once
/// \file
/// An element of the tree: everything that exists at run time is a Leaf with a name, a parent, a class object and a
/// path.
///
/// One owner per object (its parent). Everybody else holds a Ref, which turns empty when the object dies.
/// Paths: components separated by '/', absolute or relative, '.' and '..'; `name[k]` is the k-th sibling of that name,
/// from 1. The tree is changed by the simulation's thread only.

#include <cstdint>
#include <string>
#include <string_view>

#include "spark/abi/spark/leaf.h"
#include "spark/interface.h"
#include "spark/ref.h"

namespace spark {

class ClassObject;
class Kernel;
class Node;
class StateReader;
class StateWriter;
template <class T>
class Description;

namespace detail {
class Tree;
}

/// A named element of the tree.
class Leaf {
 public:
  static constexpr const char* kClassName = "Leaf";
  using ClassSelf = Leaf;
  using ClassBase = Leaf;
  static constexpr InterfaceId kInterface{"Leaf", 1};
  static void describe(Description<Leaf>& d);

  Leaf() = default;
  virtual ~Leaf();
  Leaf(const Leaf&) = delete;
  Leaf& operator=(const Leaf&) = delete;

  const std::string& name() const { return name_; }
  /// Renames; siblings may share a name (the first is found by it, the others as `name[k]`). Throws Error for names
  /// that no path can hold ("", ".", "..", with '/' or '\\'), for classes and plugins, whose names are fixed, and for
  /// what is in use (InUse).
  void setName(std::string name);
  /// The owner, nullptr for the root and for what is not linked.
  Node* parent() const { return parent_; }
  /// The class that made this object. Set before onLink; nullptr only inside constructors.
  ClassObject* classObject() const { return class_; }
  /// The kernel this object lives in. Not to be called in constructors.
  Kernel& kernel() const;
  /// "/usr/scene/robot"; the root is "/". What is not linked starts with its own name.
  std::string path() const;
  /// True when this object hangs below the kernel's root.
  bool isLinked() const;

  /// This object as class or interface T, through the class object's table, together with itself; empty when it is
  /// none.
  template <class T>
  Found<T> as() const {
    T* object = static_cast<T*>(query(T::kInterface));
    return {object, object ? const_cast<Leaf*>(this) : nullptr};
  }
  /// As `as` where only the id of T is known.
  void* query(const InterfaceId& id) const;
  /// As `query`, but throws Error that says what the object lacks.
  void* requireAs(const InterfaceId& id) const;
  /// The object at `path` (relative to this one), nullptr when there is none.
  Leaf* find(std::string_view path) const;
  /// The object at `path` as T; nullptr when it is missing or no T.
  template <class T>
  T* find(std::string_view path) const {
    Leaf* found = find(path);
    return found ? found->as<T>() : nullptr;
  }
  /// As find, but throws Error that says what is missing: the path (with the nearest names) or the interface.
  template <class T>
  T& require(std::string_view path) const {
    return *static_cast<T*>(requireInterface(path, T::kInterface));
  }
  /// As `require` where only the id of T is known.
  void* requireInterface(std::string_view path, const InterfaceId& id) const;
  /// The server that offers T, at its well-known path `T::kPath`: nullptr when there is none, or Error.
  template <detail::HasPath T>
  T* find() const {
    return find<T>(T::kPath);
  }
  template <detail::HasPath T>
  T& require() const {
    return require<T>(T::kPath);
  }
  /// The nearest ancestor that is a T, nullptr when there is none.
  template <class T>
  T* ancestor() const;

  /// This object as Node, nullptr for a mere Leaf.
  virtual Node* asNode() { return nullptr; }
  const Node* asNode() const { return const_cast<Leaf*>(this)->asNode(); }
  /// Stable number of this object in its kernel, never used again.
  std::uint64_t id() const { return id_; }

 protected:
  /// Runs when the object (and its parents) hang in the tree, before its children are linked. May throw Error: it is
  /// then not added.
  virtual void onLink() {}
  /// Runs when a parent further up changed (Node::reparent). Links need nothing here (link.h).
  virtual void onMoved() {}
  /// Runs before the object leaves the tree, after its children's. What it throws is logged.
  virtual void onUnlink() {}
  /// State that is not a property: write it in a fixed order, read it back in the same.
  virtual void saveState(StateWriter&) const {}
  virtual void loadState(StateReader&) {}

 private:
  friend class detail::Tree;
  friend detail::Life* detail::shareLife(const Leaf&);

  bool isLeaf() const { return !asNode(); }
  void unlinkLeaf();

  std::string name_;
  Node* parent_ = nullptr;
  ClassObject* class_ = nullptr;
  mutable detail::Life* life_ = nullptr;
  std::uint64_t id_ = 0;
  std::uint32_t preOrder_ = 0, postOrder_ = 0;
  std::uint32_t lastBelow_ = 0;  ///< preOrder_ of the last descendant, its own without
  bool linked_ = false;
  bool hooked_ = false;    ///< some channel has an entry of it
  bool changing_ = false;  ///< is being linked, moved or unlinked: it must stay where it is
};

}  // namespace spark
