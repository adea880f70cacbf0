#include "spark/event.h"

#include <algorithm>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark {

// Handlers are kept sorted by tree order, sorted again only when the tree's shape or the handlers changed since the last emit. While a
// channel runs, entries are only appended (they run next time) and blanked (their node left), never moved: handlers may change the tree.

void Channel::run(Entry& entry, const Event& event) {
  try {
    if (entry.plain) entry.plain(*entry.node, event);
    else entry.handler(*entry.node, event);
  } catch (const std::exception& e) {
    kernel_->log().error("{} of {} (class {}) failed: {}", name_, entry.node ? entry.node->path() : "a removed node",
                         entry.node && entry.node->classObject() ? entry.node->classObject()->name() : "?", e.what());
  }
}

void Channel::sort() {
  if (holes_) {
    std::erase_if(entries_, [](const Entry& e) { return !e.node; });
    holes_ = false;
  }
  if (!dirty_ && sortedAt_ == kernel_->structureVersion()) return;
  kernel_->updateOrder();
  const bool first = order_ == Order::parentsFirst;
  std::stable_sort(entries_.begin(), entries_.end(), [first](const Entry& a, const Entry& b) {
    return first ? a.node->preOrder_ < b.node->preOrder_ : a.node->postOrder_ < b.node->postOrder_;
  });
  sortedAt_ = kernel_->structureVersion();
  dirty_ = false;
}

void Channel::emit(const Event& event) {
  if (depth_ == 0) sort();
  ++depth_;
  const std::size_t n = entries_.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!entries_[i].node) continue;
    if (entries_[i].plain) {
      run(entries_[i], event);
    } else {
      Entry copy = entries_[i];  // the handler may add handlers, and the vector may move
      run(copy, event);
    }
  }
  --depth_;
}

void Channel::emitAt(Leaf& node, const Event& event) {
  if (depth_ == 0) sort();
  ++depth_;
  const std::size_t n = entries_.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (entries_[i].node != &node) continue;
    Entry copy = entries_[i];
    run(copy, event);
  }
  --depth_;
}

std::uint64_t Channel::add(Leaf& node, Handler handler) {
  if (!node.isLinked()) throw Error("cannot handle '" + name_ + "' at " + node.path() + ": it is not linked into the tree");
  node.hooked_ = true;
  std::uint64_t number = 1;
  for (const Entry& e : entries_) number = std::max(number, e.number + 1);
  entries_.push_back({&node, nullptr, std::move(handler), number});
  dirty_ = true;
  return number;
}

void Channel::remove(std::uint64_t subscription) {
  for (Entry& e : entries_)
    if (e.number == subscription && !e.plain) e.node = nullptr, e.handler = nullptr, holes_ = true;
}

Channel& Events::channel(std::string_view name) {
  const auto it = std::lower_bound(channels_.begin(), channels_.end(), name, [](const auto& c, std::string_view n) { return c->name_ < n; });
  if (it != channels_.end() && (*it)->name_ == name) return **it;
  auto made = std::make_unique<Channel>();
  made->name_ = name;
  made->kernel_ = &kernel_;
  return **channels_.insert(it, std::move(made));
}

Channel& Events::define(std::string_view name, Order order, std::string doc) {
  Channel& c = channel(name);
  if (!c.doc_.empty() && c.order_ != order)
    throw Error("event channel '" + std::string(name) + "' is defined already with the other order of handlers (" + c.doc_ + ")");
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

void Events::hook(Leaf& node) {
  for (const Hook* h : node.classObject()->hooks()) {
    Channel& c = channel(h->channel);
    c.entries_.push_back({&node, h->run, {}, 0});
    c.dirty_ = true;
    node.hooked_ = true;
  }
}

void Events::unhook(Leaf& node) {
  if (!node.hooked_) return;
  node.hooked_ = false;
  for (const auto& c : channels_)
    for (Channel::Entry& e : c->entries_)
      if (e.node == &node) {
        e.node = nullptr;
        e.plain = nullptr;
        c->holes_ = true;
        if (c->depth_ == 0) e.handler = nullptr;
      }
}

}  // namespace spark
