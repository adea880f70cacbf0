#pragma once
/// \file
/// The actions of one agent between their arrival and the act phase that executes them.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "spark/predicates.h"
#include "spark/state.h"

namespace spark::gamecontrol {

/// Three lists: the last message as it was parsed, the pending actions that the next act phase executes, and deferred
/// actions that become pending later.
class ActionQueue {
 public:
  /// Counts a message of `bytes`. False if more than `maxBytes` have come since the last executed() or too many
  /// actions wait; the message must not be added then.
  bool reserve(std::size_t bytes, std::size_t maxBytes);
  /// The list for the actions of the next message, emptied.
  Predicates& beginMessage();
  /// Adds the message's actions to the pending ones, or the deferred ones while held back. `keepMessage`: lastMessage()
  /// stays valid until the next message; otherwise its content may be moved.
  void endMessage(bool keepMessage);
  /// The last message.
  const Predicates& lastMessage() const { return message_; }

  /// To be executed in the next act phase.
  const Predicates& pending() const { return pending_; }
  /// Later than the next act phase.
  const Predicates& heldBack() const { return deferred_; }
  /// A behaviour adds its first actions to it.
  Predicates& pending() { return pending_; }
  /// A behaviour adds the actions to it that follow from percepts; promote() makes them pending.
  Predicates& deferred() { return deferred_; }
  /// Makes all deferred actions pending: behind those that are.
  void promote() {
    if (pending_.empty()) std::swap(pending_, deferred_);
    for (const Element e : deferred_) pending_.append(e);
    deferred_.clear();
  }
  /// Removes the pending actions, which were executed.
  void executed() {
    pending_.clear();
    bytes_ = 0;
  }
  /// True in a cycle that executes no actions: the first one, and the one after releaseHeldBack(). Resets it.
  bool takeSkip() { return std::exchange(skipNext_, false); }

  /// Defers all actions except those with the head `first`, received ones and those to come.
  void holdBack(std::string_view first);
  /// True from holdBack() to releaseHeldBack().
  bool holdingBack() const { return holdingBack_; }
  /// Makes the deferred actions pending, before those that are; the next cycle executes nothing, so that they are
  /// executed one cycle later.
  void releaseHeldBack();

  /// Number of tokens of pending and deferred actions.
  std::size_t tokens() const { return pending_.size() + deferred_.size(); }
  /// Saves the pending and the deferred actions.
  void save(StateWriter& out) const;
  void load(StateReader& in);
  /// Saves what is held back and skipped.
  void saveHold(StateWriter& out) const;
  void loadHold(StateReader& in);

 private:
  void append(const Predicates& actions);

  bool skipNext_ = true, holdingBack_ = false;
  std::size_t bytes_ = 0;  ///< received since the last executed()
  Predicates pending_, deferred_, message_;
  std::string first_;  ///< head of the actions that are not held back
};

/// Replaces `to` by a list of predicates that was saved with toList().
void loadPredicates(StateReader& in, Predicates& to);

}  // namespace spark::gamecontrol
