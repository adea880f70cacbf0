#pragma once
/// \file
/// Events: named channels whose handlers run in tree order. Plugins define them; the phases of a cycle are channels.

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

/// The event that is passed to handlers. Valid during the call only.
struct Event {
  std::string_view name;        ///< of the channel
  double time = 0;              ///< clock of the emitter [s]
  double step = 0;              ///< since the last event of this kind [s]
  std::int64_t cycle = 0;       ///< counter of the emitter
  const Value* data = nullptr;  ///< further data, nullptr if there is none
  Value* answer = nullptr;      ///< set to what a script's handler returns; nullptr: the emitter does not want it
};

/// A node whose events come from elsewhere, such as from another host: emit() passes it by, emitAt() reaches it.
class IEventSource {
 public:
  SPARK_INTERFACE(IEventSource, 1);
  virtual ~IEventSource() = default;
  /// A handler is being added to the node, for a channel of that name. If it throws, the handler is not added.
  virtual void listened(const std::string& channel) = 0;
};

/// The order in which the handlers of a channel run. Handlers of one node run in the order in which they were added.
enum class Order { parentsFirst, childrenFirst };

/// A named event with its handlers. Owned by the kernel's Events and valid as long as the kernel. The simulation's
/// thread only.
class Channel {
 public:
  /// Handles an event at a node.
  using Handler = std::function<void(Leaf&, const Event&)>;
  /// Runs all handlers in tree order, but for those of an IEventSource. Handlers may add and remove nodes and handlers;
  /// new handlers run from the next event on. A handler that throws is logged once and counted (Kernel::faults).
  void emit(const Event& event);
  /// Runs only the handlers of `node` itself.
  void emitAt(Leaf& node, const Event& event);
  /// Adds a handler to a linked node until the node is unlinked. Returns a number for remove(). Throws Error if the
  /// node is not linked, and what IEventSource::listened() throws.
  std::uint64_t add(Leaf& node, Handler handler);
  /// Removes the handler for which add() returned this number. Ignores 0 and unknown numbers.
  void remove(std::uint64_t subscription);
  /// True if the channel has no handlers.
  bool empty() const { return entries_.empty() && pending_.empty(); }
  /// The name.
  const std::string& name() const { return name_; }
  /// One sentence about the event, "" until the channel is defined.
  const std::string& doc() const { return doc_; }
  /// The order of its handlers.
  Order order() const { return order_; }

 private:
  friend class Events;
  struct Entry {
    Leaf* node;                          // nullptr once removed
    void (*plain)(Leaf&, const Event&);  // of a hook; nullptr if `handler` is used
    Handler handler;
    std::uint64_t number;    // of the subscription, 0 for a hook
    bool elsewhere = false;  // the node's events come from elsewhere
    bool faulty = false;     // it has thrown and been logged
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
  std::vector<Entry> entries_;
  std::vector<Entry> pending_;  // handlers that were added while the channel runs
  std::uint64_t sortedAt_ = 0;  // structureVersion for which entries_ are sorted
  std::uint64_t lastNumber_ = 0;
  int depth_ = 0;       // nested emits
  bool dirty_ = false;  // entries_ must be sorted again
  bool holes_ = false;  // entries_ contain removed handlers
};

/// All channels of a kernel. The simulation's thread only.
class Events {
 public:
  /// Made by the kernel only.
  explicit Events(Kernel& kernel) : kernel_(kernel) {}
  /// Defines a channel: its order and one sentence about it. Handlers may have been added before. Throws Error if the
  /// channel is defined already with another order.
  Channel& define(std::string_view name, Order order, std::string doc);
  /// The channel of that name. It is made if there is none, so that handlers can be added before it is defined.
  Channel& channel(std::string_view name);
  /// All channels in order of name.
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
