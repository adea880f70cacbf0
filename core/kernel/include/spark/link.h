#pragma once
/// \file
/// Links: how a node finds what it works with, declared once and looked up by the kernel.
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
/// A link is looked up when it is read and the tree has changed since it was looked up last; else reading it costs one
/// comparison. It holds what is linked only (hangs in the tree), so it is empty as soon as its target leaves.
/// `sparkhost --describe` and `sparkctl tree --links` show links.

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

/// A way through the tree to objects of a class or interface: one search after the other, each from where the last one
/// ended. The typed ones are made by Above, Below, Child, Beside and At.
class AnyRoute {
 public:
  enum class Search { above, below, child, beside, at, atProperty };
  struct Step {
    Search search;
    InterfaceId id;
    std::string path = {};                                ///< of `at`
    std::function<std::string(const Leaf&)> pathOf = {};  ///< of `atProperty`
    std::function<bool(const void*)> accepts = {};        ///< empty: all
    std::string what = {};                                ///< what `accepts` wants, for people; "" for the id's name
  };
  explicit AnyRoute(Step step) { steps_.push_back(std::move(step)); }

  class Walk;

  /// The first match; empty when there is none. Leaves out what is not linked where `from` is.
  Found<void> find(const Leaf& from) const;
  /// All matches, in tree order.
  void findAll(const Leaf& from, std::vector<Found<void>>& out) const;
  /// For people: "the IRigidBody below the Transform above".
  std::string text() const;
  /// Throws Error: what was expected and where the search ended.
  [[noreturn]] void throwMissing(const Leaf& from) const;

 protected:
  std::vector<Step> steps_;
};

/// A route that ends at a T.
template <class T>
class Route : public AnyRoute {
 public:
  using AnyRoute::AnyRoute;
  /// The first match; empty when there is none. For set-up: in the step a Link remembers it.
  Found<T> find(const Leaf& from) const {
    const Found<void> found = AnyRoute::find(from);
    return {static_cast<T*>(found.object), found.leaf};
  }
  /// Goes on from what was found so far.
  template <class U>
  Route<U> above() && {
    return std::move(*this).template then<U>({Search::above, U::kInterface});
  }
  template <class U>
  Route<U> below() && {
    return std::move(*this).template then<U>({Search::below, U::kInterface});
  }
  template <class U>
  Route<U> child() && {
    return std::move(*this).template then<U>({Search::child, U::kInterface});
  }
  /// The last search takes only objects of which Accepts(const T&) is true; `what` names them, e.g. "HingeJoint".
  template <auto Accepts>
  Route where(std::string what) && {
    this->steps_.back().accepts = [](const void* object) { return Accepts(*static_cast<const T*>(object)); };
    this->steps_.back().what = std::move(what);
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
/// What is at a path, absolute or relative to the node; empty when it is no T.
template <class T>
Route<T> At(std::string path) {
  return Route<T>({AnyRoute::Search::at, T::kInterface, std::move(path)});
}
/// What is at the interface's well-known path, e.g. At<IPhysicsServer>(): `T::kPath`.
template <detail::HasPath T>
Route<T> At() {
  return At<T>(T::kPath);
}
/// What is at the path that a property of the node holds; "" for nothing. Its setter calls Link::lookAgain().
template <class T, class Self>
Route<T> At(std::string Self::*property) {
  AnyRoute::Step step{AnyRoute::Search::atProperty, T::kInterface};
  step.pathOf = [property](const Leaf& l) { return static_cast<const Self&>(l).*property; };
  return Route<T>(std::move(step));
}

namespace detail {
/// What all links of one declaration share.
struct LinkSite {
  const std::uint64_t* version;  ///< the kernel's structureVersion
  const AnyRoute* route;
  std::ptrdiff_t offset = 0;   ///< of the link in its owner [bytes]
  const Leaf* from = nullptr;  ///< instead of the owner: a link that is no member of a node
};
inline constexpr std::uint64_t kNeverChanges = 0;
inline constexpr LinkSite kNoSite{&kNeverChanges, nullptr};

class LinkBase {
 public:
  LinkBase() = default;
  LinkBase(const LinkBase&) = delete;
  LinkBase& operator=(const LinkBase&) = delete;
  /// Makes the next read look it up: what the route depends on has changed, and not the tree.
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
  /// What was looked up holds until the tree changes; an owner that is not linked does not hear of changes around it.
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
/// A T gives its leaf itself.
template <class T>
concept KnowsLeaf = std::is_base_of_v<Leaf, T> || requires(T& t) {
  t.leaf();
};
}  // namespace detail

/// The object that a route leads to, seen from the node that has the link as a member (declared in its describe()).
/// Several threads may read it at a time while the tree does not change. `kKnows` is named for a T that is not complete
/// yet.
template <class T, bool kKnows = detail::KnowsLeaf<T>>
class Link : public detail::LinkBase {
 public:
  /// The object; nullptr when there is none.
  T* get() const {
    if (isStale()) update();
    return object_.load(std::memory_order_relaxed);
  }
  /// Its leaf; nullptr when there is none.
  Leaf* leaf() const {
    T* object = get();
    if constexpr (!kKnows)
      return object ? leaf_.load(std::memory_order_relaxed) : nullptr;
    else if constexpr (std::is_base_of_v<Leaf, T>)
      return object;
    else
      return object ? &object->leaf() : nullptr;
  }
  Found<T> found() const { return {get(), leaf()}; }
  /// The object. Throws Error when there is none: what was expected where.
  T& require() const {
    if (T* object = get()) return *object;
    throwMissing();
  }
  /// Precondition of -> and *: it is not empty.
  T* operator->() const {
    T* object = get();
    SPARK_ASSERT(object);
    return object;
  }
  T& operator*() const { return *operator->(); }
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

/// All objects that a route leads to, in tree order. The simulation's thread only.
template <class T>
class Links : public detail::LinkBase {
 public:
  const std::vector<Found<T>>& all() const {
    if (isStale()) update();
    return all_;
  }
  auto begin() const { return all().begin(); }
  auto end() const { return std::as_const(all_).end(); }
  std::size_t size() const { return all().size(); }
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

/// Says whether the tree has changed: for tables that are made of what stands in it.
///
///     if (tree_.changed(*this)) listPlayers();
class TreeWatch {
 public:
  /// True when somebody came, went, moved or got another name since the last call, and at the first call.
  bool changed(const Leaf& anyNode);
  /// What changed() would say.
  bool isStale(const Leaf& anyNode) const;
  /// The next call of changed() says true.
  void lookAgain() { at_ = 0; }

 private:
  std::uint64_t at_ = 0;
};

/// A link of an object that is no node itself: looked up from `from`, which must outlive it.
template <class T>
class FreeLink : public Link<T> {
 public:
  FreeLink(const Leaf& from, Route<T> route) : route_(std::move(route)) {
    own_ = {&this->structureVersionOf(from), &route_, 0, &from};
    this->bind(own_);
  }

 private:
  Route<T> route_;
  detail::LinkSite own_;
};

}  // namespace spark
