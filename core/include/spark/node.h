#pragma once
/// \file
/// The tree: everything that exists at run time is a Leaf with a name, a parent, a class object and a path.
///
/// One owner per object (its parent). Everybody else holds a Ref, which turns empty when the object dies.
/// Paths: components separated by '/', absolute or relative, '.' and '..'; `name[k]` is the k-th sibling of that name,
/// from 1. The tree is changed by the simulation's thread only.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "spark/abi/spark/node.h"

namespace spark {

class ClassObject;
class Kernel;
class Leaf;
class Node;
class StateReader;
class StateWriter;

/// Asks for memory that will be read soon; what it holds and whether it is there does not matter. For loops over nodes
/// in the step: a solver leaves nothing of them in the caches, and those that come next can be on their way while one
/// is worked on.
inline void prefetch(const void* begin, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(static_cast<const char*>(begin) + at);
}

/// A versioned interface id. Two ids are equal when name and version are; the number is a hash of both.
struct InterfaceId {
  const char* name;
  unsigned version;
  std::uint64_t id;
  constexpr InterfaceId(const char* n, unsigned v) : name(n), version(v), id(14695981039346656037ull) {
    for (const char* c = n; *c; ++c) id = (id ^ static_cast<unsigned char>(*c)) * 1099511628211ull;
    id = (id ^ v) * 1099511628211ull;
  }
};

/// In an interface's definition: gives it its id.
#define SPARK_INTERFACE(Name, Version) \
  static constexpr ::spark::InterfaceId kInterface { #Name, Version }

/// In a class's definition: its name in the tree and its base. The compiler checks the rest when the plugin registers
/// it.
#define SPARK_CLASS(Self, Base)                               \
 public:                                                      \
  static constexpr const char* kClassName = #Self;            \
  using ClassSelf = Self;                                     \
  using ClassBase = Base;                                     \
  static constexpr ::spark::InterfaceId kInterface{#Self, 1}; \
                                                              \
 private:

namespace detail {
/// An interface that one server offers, at a place where everybody finds it.
template <class T>
concept HasPath = requires {
  T::kPath;
};

/// Outlives its leaf while references remain; `leaf` is nulled when the leaf dies.
struct Life {
  Leaf* leaf;
  unsigned references;
};
}  // namespace detail

/// An object of the tree, as the leaf that it is and as the T that it offers.
template <class T>
struct Found {
  T* object = nullptr;
  Leaf* leaf = nullptr;
  T* operator->() const { return object; }
  std::add_lvalue_reference_t<T> operator*() const { return *object; }
  explicit operator bool() const { return object != nullptr; }
};

/// A checked, non-owning reference: empty once the object died. Copy and assign it on the simulation's thread; read it
/// anywhere.
template <class T>
class Ref {
 public:
  Ref() = default;
  Ref(T* object);
  Ref(const Found<T>& found);
  Ref(const Ref& other) noexcept : life_(other.life_), object_(other.object_) {
    if (life_) ++life_->references;
  }
  Ref(Ref&& other) noexcept
      : life_(std::exchange(other.life_, nullptr)), object_(std::exchange(other.object_, nullptr)) {}
  Ref& operator=(const Ref& other) {
    if (other.life_) ++other.life_->references;
    release();
    life_ = other.life_;
    object_ = other.object_;
    return *this;
  }
  ~Ref() { release(); }

  /// The object, or nullptr when it is dead or was never set.
  T* get() const { return life_ && life_->leaf ? object_ : nullptr; }
  T* operator->() const { return get(); }
  T& operator*() const { return *get(); }
  explicit operator bool() const { return get() != nullptr; }

 private:
  void release() {
    if (life_ && --life_->references == 0) delete life_;
  }
  detail::Life* life_ = nullptr;
  T* object_ = nullptr;
};

/// A named element of the tree.
class Leaf {
 public:
  static constexpr const char* kClassName = "Leaf";
  static constexpr InterfaceId kInterface{"Leaf", 1};

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

  /// This object as class or interface T, through the class object's table; nullptr when it is none.
  template <class T>
  T* as() const {
    return static_cast<T*>(query(T::kInterface));
  }
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
  friend class Node;
  friend class Kernel;
  friend class ClassObject;
  friend class Events;
  friend class Channel;
  friend class AnyRoute;
  template <class>
  friend class Ref;
  friend std::uint64_t stateHash(const Leaf&);
  friend void saveTree(const Leaf&, StateWriter&);
  friend void loadTree(Leaf&, StateReader&);

  void* query(const InterfaceId& id) const;
  void* requireInterface(std::string_view path, const InterfaceId& id) const;
  detail::Life* life() const;

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

/// Says that a leaf is in use: code of it is at work, or others live in it. While one of these lives, the leaf and what
/// is above it can neither be removed nor moved nor renamed: that throws Error with `why`. The simulation's thread
/// only.
class InUse {
 public:
  /// What is below keeps its name, too: for servers, which are found by their paths.
  static constexpr int kAllBelow = 1 << 20;
  /// `why` finishes the sentence "it is in use: ..." and outlives this object. `namesBelow`: how many levels below keep
  /// their names.
  InUse(const Leaf& leaf, std::string_view why, int namesBelow = 0);
  ~InUse();
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  friend class Kernel;
  Ref<Leaf> leaf_;
  std::string_view why_;
  int namesBelow_;
  InUse** link_;  ///< what points at this one in the kernel's list
  InUse* next_;
};

/// A Leaf that owns children, in order.
class Node : public Leaf {
 public:
  static constexpr const char* kClassName = "Node";
  using ClassSelf = Node;
  using ClassBase = Leaf;
  static constexpr InterfaceId kInterface{"Node", 1};

  ~Node() override;
  Node* asNode() override { return this; }

  /// The children in order; owned by this node, valid until the tree changes.
  const std::vector<std::unique_ptr<Leaf>>& children() const { return children_; }
  /// The kernel's structureVersion() when somebody came, went, or got another name below this node last: who looks only
  /// at what is below looks again when this grew.
  std::uint64_t changedAt() const { return changedAt_; }
  /// The first child of that name, nullptr when there is none. Takes `name[k]`.
  Leaf* child(std::string_view name) const;
  /// The tree is no deeper than this.
  static constexpr int kMostLevels = 1000;
  /// Appends and links. Throws what onLink throws; the tree is then as before.
  Leaf& add(std::unique_ptr<Leaf> leaf);
  /// Makes an object of the named class, names it (unless `name` is empty) and adds it. Throws Error.
  Leaf& create(std::string_view className, std::string_view name = {});
  /// Makes an object and returns it as T. Throws Error when the class has no such interface.
  template <class T>
  T& create(std::string_view className, std::string_view name = {}) {
    Leaf& leaf = create(className, name);
    if (T* t = leaf.as<T>()) return *t;
    throwLacks(leaf, T::kInterface);
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
  /// The first child that is a T, nullptr when there is none.
  template <class T>
  T* childOf() const {
    for (const auto& c : children_)
      if (T* match = c->as<T>()) return match;
    return nullptr;
  }

 private:
  friend class AnyRoute;
  friend class Leaf;
  friend class Kernel;
  friend class Loader;
  [[noreturn]] static void throwLacks(const Leaf& leaf, const InterfaceId& id);
  struct Changing;
  Leaf& attach(std::unique_ptr<Leaf> leaf);
  void detach(Leaf& child);
  std::size_t indexOf(const Leaf& child) const;
  using Take = void (*)(void* list, void* match, Leaf& leaf);
  void collectAs(const InterfaceId& id, bool deep, Take take, void* list) const;
  void walk(const InterfaceId& id, bool deep, Take take, void* list) const;
  static bool isFixed(const Leaf& leaf);
  static void mustRest(const Leaf& leaf, const char* verb);
  static void linkChildren(Node& node);
  static void unlinkChildren(Leaf& leaf);
  static void leave(Leaf& leaf);
  static void bury(Leaf& leaf);
  static void link(Leaf& leaf);
  static void unlink(Leaf& leaf);
  static void moved(Leaf& leaf);
  /// Children of one name, in order.
  using Names = std::unordered_map<std::string_view, std::vector<Leaf*>>;
  void rememberName(Leaf& child);
  std::size_t ordinal(const Leaf& child) const;
  Leaf* numbered(std::string_view name, std::size_t n) const;
  /// To be called before children go, move or get other names.
  void forgetNames() { names_.reset(); }
  static void destroyBelow(Node& node);
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

template <class T>
Ref<T>::Ref(const Found<T>& found) : object_(found.object) {
  if (!found) return;
  life_ = found.leaf->life();
  ++life_->references;
}

template <class T>
Ref<T>::Ref(T* object) : object_(object) {
  Leaf* leaf = nullptr;
  if constexpr (std::is_base_of_v<Leaf, T>)
    leaf = object;
  else
    leaf = object ? &object->leaf() : nullptr;
  if (leaf) {
    life_ = leaf->life();
    ++life_->references;
  }
}

}  // namespace spark
