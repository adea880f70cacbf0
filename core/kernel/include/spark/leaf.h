#pragma once
/// \file
/// An element of the tree. Everything that exists at run time is a Leaf with a name, a parent, a class object and a
/// path.
///
/// Ownership: an object is owned by its parent. All other code refers to it by a Ref, which becomes empty when the
/// object is destroyed.
///
/// Paths: names separated by '/', absolute or relative to an object. '.' is the object itself and '..' its parent;
/// `name[k]` is the k-th sibling of that name, from 1.
///
/// Threads: only the simulation's thread changes the tree.

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
  // As SPARK_CLASS(Leaf, Leaf).
  static constexpr const char* kClassName = "Leaf";
  using ClassSelf = Leaf;
  using ClassBase = Leaf;
  static constexpr InterfaceId kInterface{"Leaf", 1};
  /// Describes the class.
  static void describe(Description<Leaf>& d);

  /// A leaf without name, class and parent. Class objects construct all leaves (ClassObject::create).
  Leaf() = default;
  /// Empties all references to the object.
  virtual ~Leaf();
  Leaf(const Leaf&) = delete;
  Leaf& operator=(const Leaf&) = delete;

  /// The name, which need not be unique among siblings.
  const std::string& name() const { return name_; }
  /// Renames the object. Among siblings of one name the first is found by the name and the others as `name[k]`. Throws
  /// Error for a name that is not possible in a path ("", ".", "..", or with '/' or '\\'), for classes and plugins,
  /// whose names are fixed, and for an object that is in use (InUse).
  void setName(std::string name);
  /// The owner; nullptr for the root and for an object that has not been added to a node.
  Node* parent() const { return parent_; }
  /// The class that made this object; nullptr only inside constructors.
  ClassObject* classObject() const { return class_; }
  /// The kernel of this object. Throws Error inside constructors, where the object has no kernel yet.
  Kernel& kernel() const;
  /// The path from the root, such as "/usr/scene/robot"; "/" for the root. The path of an object that is not linked
  /// begins with the name of its topmost ancestor instead of '/'.
  std::string path() const;
  /// True if this object is part of the tree, that is, it is the kernel's root or below it.
  bool isLinked() const;

  /// This object as class or interface T, by a lookup in the table of its class. Empty if it is not a T.
  template <class T>
  Found<T> as() const {
    T* object = static_cast<T*>(query(T::kInterface));
    return {object, object ? const_cast<Leaf*>(this) : nullptr};
  }
  /// As as(), for a T of which only the id is known. The pointer points to a T.
  void* query(const InterfaceId& id) const;
  /// As query(), but throws Error with the missing interface.
  void* requireAs(const InterfaceId& id) const;
  /// The object at `path`, absolute or relative to this one; nullptr if there is none.
  Leaf* find(std::string_view path) const;
  /// The object at `path` as T; nullptr if there is none or it is not a T.
  template <class T>
  T* find(std::string_view path) const {
    Leaf* found = find(path);
    return found ? found->as<T>() : nullptr;
  }
  /// As find(), but throws Error if the path is missing, with the nearest names, or the interface.
  template <class T>
  T& require(std::string_view path) const {
    return *static_cast<T*>(requireInterface(path, T::kInterface));
  }
  /// As require(), for a T of which only the id is known. The pointer points to a T.
  void* requireInterface(std::string_view path, const InterfaceId& id) const;
  /// The server at the well-known path of T, `T::kPath`, as T; nullptr if there is none.
  template <detail::HasPath T>
  T* find() const {
    return find<T>(T::kPath);
  }
  /// As find<T>(), but throws Error if there is none.
  template <detail::HasPath T>
  T& require() const {
    return require<T>(T::kPath);
  }
  /// The nearest ancestor that is a T; nullptr if there is none.
  template <class T>
  T* ancestor() const;

  /// This object as Node; nullptr if it cannot have children.
  virtual Node* asNode() { return nullptr; }
  /// As above, for a const object.
  const Node* asNode() const { return const_cast<Leaf*>(this)->asNode(); }
  /// The number of this object, unique in its kernel for all time, from 1. Later objects have greater numbers.
  std::uint64_t id() const { return id_; }

 protected:
  /// Runs when the object has joined the tree, before its children join. If it throws, the object is removed again.
  virtual void onLink() {}
  /// Runs when the object or one of its ancestors has another parent (Node::reparent). Links are updated without it.
  virtual void onMoved() {}
  /// Runs before the object leaves the tree, when its children have left. An exception is logged.
  virtual void onUnlink() {}
  /// Writes state that is not a property, in a fixed order.
  virtual void saveState(StateWriter&) const {}
  /// Reads the state that saveState() wrote, in the same order.
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
  std::uint32_t preOrder_ = 0, postOrder_ = 0;  ///< indices in tree order, parents first and children first
  std::uint32_t lastBelow_ = 0;                 ///< preOrder_ of the last descendant, or its own without descendants
  bool linked_ = false;
  bool hooked_ = false;    ///< a channel has a handler of this object
  bool changing_ = false;  ///< it is being linked, moved or unlinked, and must not be removed or moved meanwhile
};

}  // namespace spark
