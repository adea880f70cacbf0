#pragma once
/// \file
/// Record of the answers of one agent in lockstep.

#include "spark/state_stream.h"

namespace spark::gamecontrol {

/// Counts sync messages. An agent that has ever sent one is waited for in every cycle; after `kProbation` answers, or
/// if it was expected at the start, it is trusted, and waiting for it is not limited by a budget.
class LockstepRecord {
 public:
  /// A message came. `sync`: it contains the sync predicate.
  void onMessage(bool sync) {
    synced_ |= sync;
    pledged_ |= synced_;
  }
  /// A cycle begins: its answer has not come yet.
  void beginCycle() { synced_ = false; }
  /// Counts the answer to the last cycle, if there was one. Call it before beginCycle().
  void countAnswer() { answers_ += synced_; }
  /// After the agent delayed others for too long: it is not waited for until it answers again, and must pass the
  /// probation again.
  void distrust() { answers_ = 0, pledged_ = false; }
  /// The agent is one of those that the start of the match waited for.
  void setExpected(bool expected) { expected_ = expected; }

  /// Goes on after a new connection, whose record is `client`: what it sent so far is its answer to this cycle.
  void resume(const LockstepRecord& client) {
    synced_ = client.synced_;
    pledged_ |= client.pledged_;
    expected_ |= client.expected_;
  }
  void save(StateWriter& out) const {
    for (const bool b : {pledged_, synced_, expected_}) out.write(b);
    out.write(answers_);
  }
  void load(StateReader& in) {
    for (bool* b : {&pledged_, &synced_, &expected_}) *b = in.readBool();
    answers_ = static_cast<int>(in.readInteger());
  }

  /// It has ever sent a sync predicate, since distrust().
  bool pledged() const { return pledged_; }
  /// It has sent a sync predicate in this cycle.
  bool synced() const { return synced_; }
  bool expected() const { return expected_; }
  bool trusted() const { return expected_ || answers_ >= kProbation; }

 private:
  static constexpr int kProbation = 100;  // answers
  bool pledged_ = false, synced_ = false, expected_ = false;
  int answers_ = 0;
};

}  // namespace spark::gamecontrol
