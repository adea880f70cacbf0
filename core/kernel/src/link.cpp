#include "spark/link.h"

#include <fmt/format.h>

#include <string_view>

#include "spark/error.h"
#include "spark/kernel.h"

namespace spark {

namespace {
using Search = AnyRoute::Search;

/// The name of the class or interface that a step searches for.
std::string_view nameOf(const AnyRoute::Step& step) {
  return step.what.empty() ? std::string_view(step.id.name) : step.what;
}

const char* articleOf(std::string_view name) {
  const bool vowel = !name.empty() && std::string_view("AEIOUaeiou").find(name.front()) != std::string_view::npos;
  return vowel ? "an" : "a";
}

/// Where a step searches, in words, as seen from `origin`.
std::string placeOf(const AnyRoute::Step& step, const std::string& origin) {
  switch (step.search) {
    case Search::above:
      return "above " + origin;
    case Search::below:
      return "below " + origin;
    case Search::child:
      return "among the children of " + origin;
    case Search::beside:
      return "beside " + origin;
    case Search::at:
      if (step.path.starts_with('/') || origin == "it") return "at " + step.path;
      return fmt::format("at {} of {}", step.path, origin);
    default:
      return "at the path that it names";
  }
}
}  // namespace

/// Finds the matches of one step.
class AnyRoute::Walk {
 public:
  Walk(const Step& step, const Leaf& from) : step_(step), from_(from), linkedOnly_(from.isLinked()) {}

  /// Calls take(Found<void>) for each match, in tree order, until it returns false.
  template <class Take>
  void run(Take take) const {
    switch (step_.search) {
      case Search::above:
        for (Leaf* up = from_.parent(); up; up = up->parent())
          if (const Found<void> match = matching(*up); match && !take(match)) return;
        return;
      case Search::below:
        if (from_.asNode()) below(*from_.asNode(), take);
        return;
      case Search::child:
        if (from_.asNode()) children(*from_.asNode(), take);
        return;
      case Search::beside:
        if (from_.parent()) children(*from_.parent(), take);
        return;
      case Search::at:
      case Search::atProperty: {
        const std::string path = step_.pathOf ? step_.pathOf(from_) : step_.path;
        Leaf* there = path.empty() ? nullptr : from_.find(path);
        if (const Found<void> match = there ? matching(*there) : Found<void>{}) take(match);
      }
    }
  }

 private:
  Found<void> matching(Leaf& leaf) const {
    if (linkedOnly_ && !leaf.isLinked()) return {};
    void* object = leaf.query(step_.id);
    if (!object || (step_.accepts && !step_.accepts(object))) return {};
    return {object, &leaf};
  }
  template <class Take>
  void children(const Node& node, Take take) const {
    for (const auto& c : node.children())
      if (const Found<void> match = matching(*c); match && !take(match)) return;
  }
  template <class Take>
  bool below(const Node& node, Take take) const {
    for (const auto& c : node.children()) {
      if (const Found<void> match = matching(*c); match && !take(match)) return false;
      if (c->asNode() && !below(*c->asNode(), take)) return false;
    }
    return true;
  }
  const Step& step_;
  const Leaf& from_;
  const bool linkedOnly_;
};

Found<void> AnyRoute::find(const Leaf& from) const {
  Found<void> at;
  const Leaf* here = &from;
  for (const Step& step : steps_) {
    at = {};
    Walk(step, *here).run([&at](const Found<void>& match) {
      at = match;
      return false;
    });
    if (!at) return {};
    here = at.leaf;
  }
  return at;
}

void AnyRoute::findAll(const Leaf& from, std::vector<Found<void>>& out) const {
  // All steps but the last lead to their first match.
  const Leaf* here = &from;
  if (steps_.size() > 1) {
    AnyRoute first = *this;
    first.steps_.pop_back();
    here = first.find(from).leaf;
  }
  if (!here) return;
  const Step& last = steps_.back();
  // In the tree all descendants are collected from the kernel's flat list.
  if (last.search == Search::below && !last.accepts && here->isLinked() && here->asNode()) {
    here->kernel().updateOrder();
    return here->asNode()->collectAs(
        last.id, true,
        [](void* list, void* match, Leaf& leaf) {
          static_cast<std::vector<Found<void>>*>(list)->push_back({match, &leaf});
        },
        &out);
  }
  Walk(last, *here).run([&out](const Found<void>& match) {
    out.push_back(match);
    return true;
  });
}

std::string AnyRoute::text() const {
  std::string origin = "it", place;
  for (const Step& step : steps_) {
    place = placeOf(step, origin);
    origin = fmt::format("the {} {}", nameOf(step), place);
  }
  const std::string_view name = nameOf(steps_.back());
  return fmt::format("{} {} {}", articleOf(name), name, place);
}

void AnyRoute::throwMissing(const Leaf& from) const {
  // For a plain path the text names the nearest names.
  if (steps_.size() == 1 && steps_[0].search == Search::at) from.requireInterface(steps_[0].path, steps_[0].id);
  throw Error(fmt::format("{}: expected {}, found none", from.path(), text()));
}

bool TreeWatch::changed(const Leaf& anyNode) {
  const std::uint64_t now = anyNode.kernel().structureVersion();
  return std::exchange(at_, now) != now;
}

bool TreeWatch::isStale(const Leaf& anyNode) const { return at_ != anyNode.kernel().structureVersion(); }

namespace detail {

Found<void> LinkBase::lookUp() const { return site_->route->find(owner()); }

void LinkBase::lookUpAll(std::vector<Found<void>>& out) const { site_->route->findAll(owner(), out); }

void LinkBase::looked() const { at_.store(owner().isLinked() ? *site_->version : kStale, std::memory_order_release); }

void LinkBase::throwMissing() const {
  if (!site_->route) throw Error("a link was read that no describe() declares: add d.link(&Class::member, ...) there");
  site_->route->throwMissing(owner());
}

const std::uint64_t& LinkBase::structureVersionOf(const Leaf& leaf) { return leaf.kernel().structureVersion(); }

}  // namespace detail
}  // namespace spark
