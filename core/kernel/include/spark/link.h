#pragma once
/// \file
/// Links: members that lead to the objects a node works with. A class declares their routes, the kernel looks them up.
///
///     class GyroRatePerceptor : public Perceptor {
///       SPARK_CLASS(GyroRatePerceptor, Perceptor)
///      public:
///       static void describe(Description<GyroRatePerceptor>& d) {
///         d.link(&GyroRatePerceptor::body_, Above<Transform>().child<IRigidBody>()).required("It senses nothing.");
///       }
///       void sense(Predicates& out, const Event&) override {
///         if (body_) write(out, body_->state().angularVelocity);
///       }
///
///      private:
///       Link<IRigidBody> body_;
///     };
///
/// Reading a link looks it up if the tree has changed since the last time; else it costs one comparison. A link of an
/// object in the tree finds only objects in the tree, so it is empty as soon as its target leaves. `sparkhost
/// --describe` and `sparkctl tree --links` show links.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "spark/abi/spark/link.h"
#include "spark/assert.h"
#include "spark/node.h"

namespace spark {

/// A way through the tree to objects of a class or interface: a sequence of searches, each of which begins where the
/// one before ended. Above, Below, Child, Beside and At make typed routes.
class AnyRoute {
 public:
  /// Where a step searches, as seen from its origin.
  enum class Search { above, below, child, beside, at, atProperty };
  /// One search for objects that have interface `id`.
  struct Step {
    Search search;
    InterfaceId id;
    std::string path = {};                                ///< for `at`
    std::function<std::string(const Leaf&)> pathOf = {};  ///< for `atProperty`: reads the path
    std::function<bool(const void*)> accepts = {};        ///< further condition; empty: none
    std::string what = {};                                ///< name of what `accepts` accepts; "": the id's name
  };
  /// A route of one step.
  explicit AnyRoute(Step step) { steps_.push_back(std::move(step)); }

  class Walk;

  /// The first match, empty if there is none. If `from` is part of the tree, so are the matches.
  Found<void> find(const Leaf& from) const;
  /// Appends all matches in tree order.
  void findAll(const Leaf& from, std::vector<Found<void>>& out) const;
  /// The route in words, such as "an IRigidBody below the Transform above it".
  std::string text() const;
  /// Throws Error that says what was expected.
  [[noreturn]] void throwMissing(const Leaf& from) const;

 protected:
  std::vector<Step> steps_;
};

/// A route that ends at a T.
template <class T>
class Route : public AnyRoute {
 public:
  using AnyRoute::AnyRoute;
  /// The first match, empty if there is none. For set-up; in the step use a Link, which keeps the result.
  Found<T> find(const Leaf& from) const {
    const Found<void> found = AnyRoute::find(from);
    return {static_cast<T*>(found.object), found.leaf};
  }
  /// The route followed by a search for the nearest ancestor that is a U.
  template <class U>
  Route<U> above() && {
    return std::move(*this).template then<U>({Search::above, U::kInterface});
  }
  /// The route followed by a search for the first descendant that is a U.
  template <class U>
  Route<U> below() && {
    return std::move(*this).template then<U>({Search::below, U::kInterface});
  }
  /// The route followed by a search for the first child that is a U.
  template <class U>
  Route<U> child() && {
    return std::move(*this).template then<U>({Search::child, U::kInterface});
  }
  /// The last search accepts only objects for which Accepts(const T&) is true. `what` names them, such as "HingeJoint".
  template <auto Accepts>
  Route where(std::string what) && {
    AnyRoute::Step& last = AnyRoute::steps_.back();
    last.accepts = [](const void* object) { return Accepts(*static_cast<const T*>(object)); };
    last.what = std::move(what);
    return std::move(*this);
  }

 private:
  template <class>
  friend class Route;
  template <class U>
  Route<U> then(Step step) && {
    Route<U> out(std::move(step));
    out.steps_.insert(out.steps_.begin(), std::make_move_iterator(this->steps_.begin()),
                      std::make_move_iterator(this->steps_.end()));
    return out;
  }
};

/// The nearest ancestor that is a T.
template <class T>
Route<T> Above() {
  return Route<T>({AnyRoute::Search::above, T::kInterface});
}
/// The first descendant that is a T, depth first.
template <class T>
Route<T> Below() {
  return Route<T>({AnyRoute::Search::below, T::kInterface});
}
/// The first child that is a T.
template <class T>
Route<T> Child() {
  return Route<T>({AnyRoute::Search::child, T::kInterface});
}
/// The first child of the parent that is a T.
template <class T>
Route<T> Beside() {
  return Route<T>({AnyRoute::Search::beside, T::kInterface});
}
/// The object at a path, absolute or relative to the node, if it is a T.
template <class T>
Route<T> At(std::string path) {
  return Route<T>({AnyRoute::Search::at, T::kInterface, std::move(path)});
}
/// The server at the well-known path of an interface, `T::kPath`, as in At<IPhysicsServer>().
template <detail::HasPath T>
Route<T> At() {
  return At<T>(T::kPath);
}
/// The object at the path that a property of the node has; "" leads to nothing. The property's setter must call
/// Link::lookAgain().
template <class T, class Self>
Route<T> At(std::string Self::*property) {
  AnyRoute::Step step{AnyRoute::Search::atProperty, T::kInterface};
  step.pathOf = [property](const Leaf& l) { return static_cast<const Self&>(l).*property; };
  return Route<T>(std::move(step));
}

namespace detail {
/// Shared by the links of one declaration, that is, by those of all objects of a class.
struct LinkSite {
  const std::uint64_t* version;  ///< the kernel's structureVersion
  const AnyRoute* route;
  std::ptrdiff_t offset = 0;   ///< of the link in its owner [bytes]
  const Leaf* from = nullptr;  ///< origin of a link that is not a member of a node; else nullptr
};
/// The site of links that have not been bound: never stale, so that they stay empty.
inline constexpr std::uint64_t kNeverChanges = 0;
inline constexpr LinkSite kNoSite{&kNeverChanges, nullptr};

/// The part of a link that does not depend on its type.
class LinkBase {
 public:
  LinkBase() = default;
  LinkBase(const LinkBase&) = delete;
  LinkBase& operator=(const LinkBase&) = delete;
  /// Makes the next read look the link up again, because the route depends on something outside the tree that has
  /// changed.
  void lookAgain() { at_.store(kStale, std::memory_order_relaxed); }

 protected:
  static constexpr std::uint64_t kStale = ~std::uint64_t{0};
  bool isStale() const { return at_.load(std::memory_order_acquire) != *site_->version; }
  const Leaf& owner() const {
    return site_->from ? *site_->from
                       : *reinterpret_cast<const Leaf*>(reinterpret_cast<const char*>(this) - site_->offset);
  }
  Found<void> lookUp() const;
  void lookUpAll(std::vector<Found<void>>& out) const;
  /// Marks the result as valid until the tree changes. The link of an owner that is not in the tree stays stale,
  /// because changes around it are not counted.
  void looked() const;
  [[noreturn]] void throwMissing() const;

  void bind(const LinkSite& site) { site_ = &site; }
  static const std::uint64_t& structureVersionOf(const Leaf& leaf);

  mutable std::atomic<std::uint64_t> at_{0};

 private:
  friend class spark::ClassObject;
  const LinkSite* site_ = &kNoSite;
};
}  // namespace detail

namespace detail {
/// A T is a leaf, or has a function leaf() that returns it.
template <class T>
concept KnowsLeaf = std::is_base_of_v<Leaf, T> || requires(T& t) {
  t.leaf();
};
}  // namespace detail

/// The object at the end of a route, as seen from the node that has the link as a member and declares it in describe().
/// Several threads may read a link at a time while the tree does not change. Give `kKnows` explicitly if T is an
/// incomplete type.
template <class T, bool kKnows = detail::KnowsLeaf<T>>
class Link : public detail::LinkBase {
 public:
  /// The object; nullptr if there is none.
  T* get() const {
    if (isStale()) update();
    return object_.load(std::memory_order_relaxed);
  }
  /// The leaf of the object; nullptr if there is none.
  Leaf* leaf() const {
    T* object = get();
    if constexpr (!kKnows)
      return object ? leaf_.load(std::memory_order_relaxed) : nullptr;
    else if constexpr (std::is_base_of_v<Leaf, T>)
      return object;
    else
      return object ? &object->leaf() : nullptr;
  }
  /// The object with its leaf.
  Found<T> found() const { return {get(), leaf()}; }
  /// The object. Throws Error if there is none, with the route in words.
  T& require() const {
    if (T* object = get()) return *object;
    throwMissing();
  }
  /// The object. Precondition: there is one.
  T* operator->() const {
    T* object = get();
    SPARK_ASSERT(object);
    return object;
  }
  /// The object. Precondition: there is one.
  T& operator*() const { return *operator->(); }
  /// True if there is an object.
  explicit operator bool() const { return get() != nullptr; }

 private:
  struct None {};
  void update() const {
    const Found<void> found = lookUp();
    object_.store(static_cast<T*>(found.object), std::memory_order_relaxed);
    if constexpr (!kKnows) leaf_.store(found.leaf, std::memory_order_relaxed);
    looked();
  }
  mutable std::atomic<T*> object_{nullptr};
  [[no_unique_address]] mutable std::conditional_t<kKnows, None, std::atomic<Leaf*>> leaf_{};
};

/// All objects at the end of a route, in tree order. The simulation's thread only.
template <class T>
class Links : public detail::LinkBase {
 public:
  /// The objects. The list is valid until the tree changes.
  const std::vector<Found<T>>& all() const {
    if (isStale()) update();
    return all_;
  }
  /// The first object.
  auto begin() const { return all().begin(); }
  /// Behind the last object. Whichever of begin() and end() is called first looks up the objects.
  auto end() const { return all().end(); }
  /// The number of objects.
  std::size_t size() const { return all().size(); }
  /// True if there are no objects.
  bool empty() const { return all().empty(); }

 private:
  void update() const {
    std::vector<Found<void>> found;
    lookUpAll(found);
    all_.clear();
    for (const Found<void>& f : found) all_.push_back({static_cast<T*>(f.object), f.leaf});
    looked();
  }
  mutable std::vector<Found<T>> all_;
};

/// Detects changes of the tree, for tables that are made from it.
///
///     if (tree_.changed(*this)) listPlayers();
class TreeWatch {
 public:
  /// True if an object has joined, left, moved or been renamed since the last call, and for the first call. `anyNode`:
  /// an object of the tree.
  bool changed(const Leaf& anyNode);
  /// The result that changed() would return, without effect on it.
  bool isStale(const Leaf& anyNode) const;
  /// Makes the next call of changed() return true.
  void lookAgain() { at_ = 0; }

 private:
  std::uint64_t at_ = 0;
};

/// A link that is not a member of a node.
template <class T>
class FreeLink : public Link<T> {
 public:
  /// A link that leads along `route` from `from`, which must outlive it.
  FreeLink(const Leaf& from, Route<T> route) : route_(std::move(route)) {
    own_ = {&this->structureVersionOf(from), &route_, 0, &from};
    this->bind(own_);
  }

 private:
  Route<T> route_;
  detail::LinkSite own_;
};

}  // namespace spark
