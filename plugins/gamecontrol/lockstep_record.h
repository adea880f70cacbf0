#pragma once
/// \file
/// Record of the answers of one agent in lockstep.

#include <algorithm>

#include "spark/state_stream.h"

namespace spark::gamecontrol {

/// Counts answers. An agent that has sent a sync predicate is bound: it is waited for in every cycle in which percepts
/// arrive at it, until it has answered each message with that predicate. Before, it is waited for as long as it has
/// answered every message with at least one of its own: while it joins it sends `(scene ...)` and `(init ...)` as well.
/// After `kProbation` answers, or if it was expected at the start, it is trusted, and waiting for it is not limited by
/// a budget.
class LockstepRecord {
 public:
  /// A message came. `sync`: it contains the sync predicate.
  void onMessage(bool sync) {
    ++messages_;
    syncs_ += sync;
    pledged_ |= sync;
  }
  /// A turn begins: no percepts have arrived at the agent.
  void beginTurn() { asked_ = told_ = 0; }
  /// Percepts have arrived: that many messages were sent, and that many dropped because the client does not read. A
  /// bound agent owes an answer to the latter, too. Percepts that are empty are no message and owe none.
  void ask(int messages, int dropped) {
    asked_ = std::max(asked_ + messages, dropped > 0 ? 1 : 0);
    told_ += messages;
  }
  /// The actions of a turn are executed: answers to it have not come yet.
  void beginCycle() {
    syncs_ = messages_ = 0;
    bound_ = pledged_;
  }
  /// Counts the answer to the last turn, if there was one. Call it before beginTurn(). `trust`: it counts for trust.
  void countAnswer(bool trust) {
    if (!bound_ && !answered()) giveUp();
    if (trust) answers_ += bound_ ? syncs_ > 0 : messages_ > 0 && told_ > 0;
  }
  /// An agent that is not bound has left a message unanswered: it is not waited for until it sends a sync predicate.
  void giveUp() { lapsed_ = true; }
  /// After the agent delayed others for too long: it is not waited for until it answers again, and must pass the
  /// probation again.
  void distrust() {
    answers_ = 0;
    pledged_ = bound_ = false;
    giveUp();
  }
  /// The agent is one of those that the start of the match waited for.
  void setExpected(bool expected) { expected_ = expected; }

  /// Goes on after a new connection, whose record is `client`: what it sent so far is its answer to this cycle.
  void resume(const LockstepRecord& client) {
    syncs_ = client.syncs_;
    messages_ = client.messages_;
    asked_ = 1;
    told_ = 0;
    pledged_ |= client.pledged_;
    bound_ = pledged_;
    lapsed_ = false;
    expected_ |= client.expected_;
  }
  void save(StateWriter& out) const {
    for (const bool b : {pledged_, bound_, lapsed_, expected_}) out.write(b);
    for (const int n : {answers_, asked_, told_, syncs_, messages_}) out.write(n);
  }
  void load(StateReader& in) {
    for (bool* b : {&pledged_, &bound_, &lapsed_, &expected_}) *b = in.readBool();
    for (int* n : {&answers_, &asked_, &told_, &syncs_, &messages_}) *n = static_cast<int>(in.readInteger());
  }

  /// It has ever sent a sync predicate, since distrust().
  bool pledged() const { return pledged_; }
  /// It had sent one before this turn's percepts arrived.
  bool bound() const { return bound_; }
  /// Before its first sync predicate it left a message unanswered.
  bool lapsed() const { return lapsed_; }
  /// It is bound, or has answered every message so far.
  bool attentive() const { return pledged_ || !lapsed_; }
  /// It has answered in this cycle, or need not.
  bool answered() const { return bound_ ? syncs_ >= asked_ : messages_ >= told_; }
  /// Number of turns that it has answered, since distrust().
  int answers() const { return answers_; }
  bool expected() const { return expected_; }
  bool trusted() const { return expected_ || answers_ >= kProbation; }

 private:
  static constexpr int kProbation = 100;  // answers
  bool pledged_ = false, bound_ = false, expected_ = false;
  bool lapsed_ = false;          ///< it left a message unanswered
  int asked_ = 1, syncs_ = 0;    ///< answers that it owes in this turn if it is bound, and has given
  int told_ = 0, messages_ = 0;  ///< the same if it is not: messages to it and from it
  int answers_ = 0;
};

}  // namespace spark::gamecontrol
