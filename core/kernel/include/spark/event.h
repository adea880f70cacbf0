#pragma once
/// \file
/// Named channels. Plugins define them (phases of a cycle are such channels), nodes handle them in tree order.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spark/abi/spark/event.h"
#include "spark/channel_name.h"
#include "spark/node.h"
#include "spark/value.h"

namespace spark {

/// What a handler gets. `data` lives during the call only and may be nullptr.
struct Event {
  std::string_view name;
  double time = 0;         ///< s, the emitter's clock
  double step = 0;         ///< s since the last event of this kind
  std::int64_t cycle = 0;  ///< the emitter's counter
  const Value* data = nullptr;
};

/// Order in which the handlers of a channel run. Within a node: order of subscription.
enum class Order { parentsFirst, childrenFirst };

/// A channel. Owned by the kernel's Events, valid as long as the kernel.
class Channel {
 public:
  using Handler = std::function<void(Leaf&, const Event&)>;
  /// Runs all handlers in tree order. A handler may add and remove nodes and handlers; what is added runs from the next
  /// time on.
  void emit(const Event& event);
  /// Runs only the handlers of this very node.
  void emitAt(Leaf& node, const Event& event);
  /// Adds a handler to a linked node; it goes when the node is unlinked. Returns a number for `remove`.
  std::uint64_t add(Leaf& node, Handler handler);
  void remove(std::uint64_t subscription);
  bool empty() const { return entries_.empty() && pending_.empty(); }
  const std::string& name() const { return name_; }
  const std::string& doc() const { return doc_; }
  Order order() const { return order_; }

 private:
  friend class Events;
  struct Entry {
    Leaf* node;  // nullptr once removed
    void (*plain)(Leaf&, const Event&);
    Handler handler;
    std::uint64_t number;
    bool faulty = false;  // it threw once, and the log says so
  };
  void sort();
  void settle();
  void insert(Entry entry);
  void blank(Entry& entry);
  void run(Entry& entry, const Event& event);
  void report(Entry& entry, const char* what);
  std::string name_, doc_;
  Order order_ = Order::parentsFirst;
  Kernel* kernel_ = nullptr;
  std::vector<Entry> entries_, pending_;  // what is added while the channel runs waits in pending_
  std::uint64_t sortedAt_ = 0, lastNumber_ = 0;
  int depth_ = 0;
  bool dirty_ = false, holes_ = false;
};

/// All channels of a kernel.
class Events {
 public:
  explicit Events(Kernel& kernel) : kernel_(kernel) {}
  /// Defines a channel (or documents one that was already listened to). Throws Error when it was defined with another
  /// order.
  Channel& define(std::string_view name, Order order, std::string doc);
  /// The channel of that name; made on demand, so that listeners may come before definers.
  Channel& channel(std::string_view name);
  /// All channels by name.
  std::vector<Channel*> all() const;
  /// True while handlers of any channel run.
  bool running() const;

 private:
  friend class detail::Tree;
  void hook(Leaf& node);
  void unhook(Leaf& node);
  Kernel& kernel_;
  std::vector<std::unique_ptr<Channel>> channels_;  // sorted by name
};

}  // namespace spark
