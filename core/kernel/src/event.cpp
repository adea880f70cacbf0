#include "spark/event.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/prefetch.h"
#include "spark/running.h"
#include "tree.h"

namespace spark {

// Handlers are sorted by tree order. They are sorted again only if the tree or the handlers have changed since the last
// event. While a channel runs, its entries are neither moved nor destroyed: new ones wait in pending_, and removed ones
// are blanked. So handlers may change the tree and the handlers, also themselves. settle() applies these changes
// afterwards.

namespace {
// Prefetch distances in handlers, and sizes in bytes; measured for crowds of agents.
constexpr std::size_t kFar = 12, kNear = 6;
constexpr std::size_t kNode = 384;  // part of a node that a handler without work reads
constexpr std::size_t kAbove = 64;  // part of its parent behind the Node, which controllers read
}  // namespace

void Channel::run(Entry& entry, const Event& event) {
  try {
    if (entry.plain)
      entry.plain(*entry.node, event);
    else
      entry.handler(*entry.node, event);
  } catch (const std::exception& e) {
    report(entry, e.what());
  } catch (...) {
    report(entry, "it threw something that is no std::exception");
  }
}

/// Counts a failure. Logs only the first one of each handler, because one that fails in every cycle would fill the
/// disk.
void Channel::report(Entry& entry, const char* what) {
  kernel_->countFault();
  if (std::exchange(entry.faulty, true)) return;
  std::string node = "a removed node";
  if (entry.node) {
    const ClassObject& c = *entry.node->classObject();
    node = c.plugin() ? fmt::format("{} (class {} of plugin {})", entry.node->path(), c.name(), c.plugin()->name())
                      : fmt::format("{} (class {})", entry.node->path(), c.name());
  }
  kernel_->log().error("{} of {} failed: {}\n  It stays; further faults of this handler are counted, not logged.",
                       name_, node, what);
}

/// Sorts the entries by tree order, if anything has changed.
void Channel::sort() {
  if (!dirty_ && sortedAt_ == kernel_->structureVersion()) return;
  kernel_->updateOrder();
  const bool first = order_ == Order::parentsFirst;
  const auto before = [first](const Entry& a, const Entry& b) {
    return first ? detail::Tree::preOrder(*a.node) < detail::Tree::preOrder(*b.node)
                 : detail::Tree::postOrder(*a.node) < detail::Tree::postOrder(*b.node);
  };
  if (!std::is_sorted(entries_.begin(), entries_.end(), before))
    std::stable_sort(entries_.begin(), entries_.end(), before);
  sortedAt_ = kernel_->structureVersion();
  dirty_ = false;
}

/// Applies the changes that handlers have made, unless the channel still runs.
void Channel::settle() {
  if (depth_ > 0) return;
  std::vector<Handler> dying;  // destroyed last, because their destructors may call this channel
  if (holes_) {
    for (Entry& e : entries_)
      if (!e.node && e.handler) dying.push_back(std::move(e.handler));
    std::erase_if(entries_, [](const Entry& e) { return !e.node; });
    holes_ = false;
  }
  if (!pending_.empty()) {
    for (Entry& e : pending_) entries_.push_back(std::move(e));
    pending_.clear();
    dirty_ = true;
  }
}

void Channel::emit(const Event& event) {
  settle();
  if (depth_ == 0) sort();
  ++depth_;
  NowRunning now(name_.c_str());
  now.beat();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    // Prefetch the node of a handler far ahead, and the parent of a nearer handler, whose node was prefetched earlier
    // and is in the cache by now.
    if (i + kFar < entries_.size()) prefetch(entries_[i + kFar].node, kNode);
    if (const Leaf* next = i + kNear < entries_.size() ? entries_[i + kNear].node : nullptr; next && next->parent())
      prefetch(next->parent() + 1, kAbove);
    if (!entries_[i].node || entries_[i].elsewhere) continue;
    now.at(entries_[i].node);
    run(entries_[i], event);
  }
  --depth_;
  if (holes_ || !pending_.empty()) settle();
}

void Channel::emitAt(Leaf& node, const Event& event) {
  settle();
  if (depth_ == 0) sort();
  ++depth_;
  const NowRunning now(name_.c_str(), &node);
  for (Entry& e : entries_)
    if (e.node == &node) run(e, event);
  --depth_;
  if (holes_ || !pending_.empty()) settle();
}

void Channel::insert(Entry entry) {
  settle();
  detail::Tree::setHooked(*entry.node, true);
  (depth_ > 0 ? pending_ : entries_).push_back(std::move(entry));
  dirty_ = true;
}

/// Removes an entry without moving the others.
void Channel::blank(Entry& entry) {
  entry.node = nullptr;
  holes_ = true;
}

std::uint64_t Channel::add(Leaf& node, Handler handler) {
  if (!node.isLinked())
    throw Error(fmt::format("cannot handle '{}' at {}: it is not linked into the tree", name_, node.path()));
  const auto source = node.as<IEventSource>();
  if (source) source->listened(name_);
  insert({&node, nullptr, std::move(handler), ++lastNumber_, bool(source)});
  return lastNumber_;
}

void Channel::remove(std::uint64_t subscription) {
  if (subscription == 0) return;  // the number of hooks
  std::vector<Handler> dying;     // as in settle()
  std::erase_if(pending_, [&](Entry& e) {
    if (e.number != subscription) return false;
    dying.push_back(std::move(e.handler));
    return true;
  });
  for (Entry& e : entries_)
    if (e.number == subscription) blank(e);
  settle();
}

Channel& Events::channel(std::string_view name) {
  const auto it = std::lower_bound(channels_.begin(), channels_.end(), name,
                                   [](const auto& c, std::string_view n) { return c->name_ < n; });
  if (it != channels_.end() && (*it)->name_ == name) return **it;
  auto made = std::make_unique<Channel>();
  made->name_ = name;
  made->kernel_ = &kernel_;
  return **channels_.insert(it, std::move(made));
}

Channel& Events::define(std::string_view name, Order order, std::string doc) {
  Channel& c = channel(name);
  if (!c.doc_.empty() && c.order_ != order)
    throw Error(
        fmt::format("event channel '{}' is defined already with the other order of handlers ({})", name, c.doc_));
  c.order_ = order;
  c.doc_ = std::move(doc);
  c.dirty_ = true;
  return c;
}

std::vector<Channel*> Events::all() const {
  std::vector<Channel*> out;
  for (const auto& c : channels_) out.push_back(c.get());
  return out;
}

bool Events::running() const {
  return std::any_of(channels_.begin(), channels_.end(), [](const auto& c) { return c->depth_ > 0; });
}

/// Adds the hooks of a node that has been linked.
void Events::hook(Leaf& node) {
  for (const Hook* h : node.classObject()->hooks()) channel(h->channel).insert({&node, h->run, {}, 0});
}

/// Removes all handlers of a node that has been unlinked.
void Events::unhook(Leaf& node) {
  if (!detail::Tree::isHooked(node)) return;
  detail::Tree::setHooked(node, false);
  std::vector<Channel::Handler> dying;  // as in Channel::settle()
  for (const auto& c : channels_) {
    std::erase_if(c->pending_, [&](Channel::Entry& e) {
      if (e.node != &node) return false;
      if (e.handler) dying.push_back(std::move(e.handler));
      return true;
    });
    for (Channel::Entry& e : c->entries_) {
      if (e.node != &node) continue;
      c->blank(e);
      // A handler that does not run now is destroyed with its node, because its code may be unmapped soon.
      if (c->depth_ == 0 && e.handler) dying.push_back(std::move(e.handler)), e.handler = nullptr;
    }
  }
}

}  // namespace spark
