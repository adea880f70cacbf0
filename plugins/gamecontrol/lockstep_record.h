#pragma once
/// \file
/// Record of the answers of one agent in lockstep.

#include <algorithm>

#include "spark/state_stream.h"

namespace spark::gamecontrol {

/// Counts sync messages. An agent that has ever sent one is waited for in every cycle in which percepts arrive at it,
/// until it has answered each message; after `kProbation` answers, or if it was expected at the start, it is trusted,
/// and waiting for it is not limited by a budget.
class LockstepRecord {
 public:
  /// A message came. `sync`: it contains the sync predicate.
  void onMessage(bool sync) {
    syncs_ += sync;
    pledged_ |= sync;
  }
  /// A turn begins: no percepts have arrived at the agent.
  void beginTurn() { asked_ = 0; }
  /// Percepts have arrived, in a number of messages. None were sent if they are empty, or the client does not read; it
  /// owes an answer all the same.
  void ask(int messages) { asked_ = std::max(asked_ + messages, 1); }
  /// The actions of a turn are executed: answers to it have not come yet.
  void beginCycle() { syncs_ = 0; }
  /// Counts the answer to the last cycle, if there was one. Call it before beginCycle().
  void countAnswer() { answers_ += syncs_ > 0; }
  /// After the agent delayed others for too long: it is not waited for until it answers again, and must pass the
  /// probation again.
  void distrust() { answers_ = 0, pledged_ = false; }
  /// The agent is one of those that the start of the match waited for.
  void setExpected(bool expected) { expected_ = expected; }

  /// Goes on after a new connection, whose record is `client`: what it sent so far is its answer to this cycle.
  void resume(const LockstepRecord& client) {
    syncs_ = client.syncs_;
    asked_ = 1;
    pledged_ |= client.pledged_;
    expected_ |= client.expected_;
  }
  void save(StateWriter& out) const {
    for (const bool b : {pledged_, expected_}) out.write(b);
    for (const int n : {answers_, asked_, syncs_}) out.write(n);
  }
  void load(StateReader& in) {
    for (bool* b : {&pledged_, &expected_}) *b = in.readBool();
    for (int* n : {&answers_, &asked_, &syncs_}) *n = static_cast<int>(in.readInteger());
  }

  /// It has ever sent a sync predicate, since distrust().
  bool pledged() const { return pledged_; }
  /// It has answered in this cycle, or need not.
  bool synced() const { return syncs_ >= asked_; }
  bool expected() const { return expected_; }
  bool trusted() const { return expected_ || answers_ >= kProbation; }

 private:
  static constexpr int kProbation = 100;  // answers
  bool pledged_ = false, expected_ = false;
  int asked_ = 1, syncs_ = 0;  ///< answers that it owes in this turn, and has given
  int answers_ = 0;
};

}  // namespace spark::gamecontrol
