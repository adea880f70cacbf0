#pragma once
/// \file
/// What is under way between an agent and the world: percepts to the agent, actions to the world.
///
///     (due cycle, message)
///
/// An agent has one queue for each direction, which it may fill while other agents sense in other threads. Game control
/// empties the queues of all agents in the order of their numbers.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "spark/predicates.h"
#include "spark/state_stream.h"

namespace spark::gamecontrol {

/// A queue of messages with due times; none overtakes an earlier one. Allocates nothing once it has held as many
/// messages, of such sizes, as it has to hold.
class TransitQueue {
 public:
  /// Adds an empty message, for the caller to fill, that arrives in the cycle `due`, or together with the message
  /// before it if that one is due later.
  Predicates& add(std::int64_t due);
  /// True if the first message is due in `cycle` or was before.
  bool hasArrived(std::int64_t cycle) const { return size_ > 0 && ring_[first_].due <= cycle; }
  /// The first message, valid until pop() or add(). Only if there is one.
  const Predicates& first() const { return ring_[first_].message; }
  /// Removes the first message.
  void pop();
  /// The message that was added last, also after pop(); empty before the first add().
  const Predicates& newest() const { return ring_[indexOf(size_ + ring_.size() - 1)].message; }
  /// Number of messages under way.
  std::size_t size() const { return size_; }
  /// Number of their tokens.
  std::size_t tokens() const;

  /// Saves the first `count` messages, and when they are due.
  void save(StateWriter& out, std::size_t count) const;
  /// Adds `count` messages that save() wrote.
  void load(StateReader& in, std::size_t count);
  /// When the newest message is due. Only if it is under way.
  std::int64_t lastDue() const { return ring_[indexOf(size_ - 1)].due; }

 private:
  struct Entry {
    std::int64_t due = 0;
    Predicates message;
  };
  std::size_t indexOf(std::size_t place) const { return (first_ + place) % ring_.size(); }

  std::vector<Entry> ring_{1};
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace spark::gamecontrol
