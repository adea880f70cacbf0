#pragma once
/// \file
/// The actions of one agent between their arrival and the act phase that executes them.
///
///     message ─► pending ─ the agents' turn ─► under way ─ actLatency ─► executed

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "gamecontrol/transit_queue.h"
#include "spark/predicates.h"
#include "spark/state.h"

namespace spark::gamecontrol {

/// The last message as it was parsed, the pending actions that depart in the next turn, deferred actions that become
/// pending later, and those that are under way.
class ActionQueue {
 public:
  /// Most tokens that wait or are under way: they take more memory than the bytes they are parsed from.
  static constexpr std::size_t kMaxTokens = 1 << 17;
  /// Counts a message of `bytes`. False if more than `maxBytes` have come since the last depart() or too many
  /// actions wait; the message must not be added then.
  bool reserve(std::size_t bytes, std::size_t maxBytes);
  /// The list for the actions of the next message, emptied.
  Predicates& beginMessage();
  /// Adds the message's actions to the pending ones, or the deferred ones while held back. `keepMessage`: lastMessage()
  /// stays valid until the next message; otherwise its content may be moved.
  void endMessage(bool keepMessage);
  /// The last message.
  const Predicates& lastMessage() const { return message_; }

  /// Received, but not under way yet.
  const Predicates& pending() const { return pending_; }
  /// Those that wait for releaseHeldBack().
  const Predicates& heldBack() const { return deferred_; }
  /// A behaviour adds its actions to it.
  Predicates& pending() { return pending_; }
  /// Removes the pending actions.
  void dropPending();
  /// The pending actions are under way from now on and take effect in the cycle `due`.
  void depart(std::int64_t due);
  /// Those that are.
  TransitQueue& underWay() { return underWay_; }
  const TransitQueue& underWay() const { return underWay_; }
  /// True in a cycle in which no actions depart or take effect: the first one, and the one after releaseHeldBack().
  bool skips() const { return skipNext_; }
  /// The same, and resets it.
  bool takeSkip() { return std::exchange(skipNext_, false); }

  /// Defers all actions except those with the head `first`, received ones and those to come.
  void holdBack(std::string_view first);
  /// True from holdBack() to releaseHeldBack().
  bool holdingBack() const { return holdingBack_; }
  /// Makes the deferred actions pending, before those that are; the next cycle executes nothing, so that they are
  /// executed one cycle later.
  void releaseHeldBack();

  /// Number of tokens of all actions that wait or are under way.
  std::size_t tokens() const { return pending_.size() + deferred_.size() + underWay_.tokens(); }
  /// Saves the pending and the deferred actions.
  void save(StateWriter& out) const;
  void load(StateReader& in);
  /// Saves what is held back and skipped.
  void saveHold(StateWriter& out) const;
  void loadHold(StateReader& in);

 private:
  void append(const Predicates& actions);

  bool skipNext_ = true, holdingBack_ = false;
  std::size_t bytes_ = 0;  ///< received since the last depart()
  Predicates pending_, deferred_, message_;
  TransitQueue underWay_;
  std::string first_;  ///< head of the actions that are not held back
};

}  // namespace spark::gamecontrol
