#pragma once
/// \file
/// Lockstep: when the next cycle may begin.
///
/// The gate waits for agents that have sent a sync predicate before and were sent percepts since, until syncTimeout. It
/// does not wait for others: an idle connection, or a client that sends (syn) only when all of its team have joined,
/// must not stop the match.
///
/// Untrusted agents (see LockstepRecord), and agents that are slow in a cycle and were not expected, may delay trusted
/// ones only within a budget of wall time. A client that joins again and again, or answers rarely, so costs a match at
/// most a tenth of its time.

#include <memory>
#include <vector>

#include "gamecontrol/participant.h"

namespace spark::gamecontrol {

/// Game control's gate in lockstep. Simulation thread.
class LockstepGate {
 public:
  using List = std::vector<std::unique_ptr<Participant>>;
  /// Times are wall time in seconds; see the properties of GameControl.
  struct Limits {
    double syncTimeout;  ///< an agent that does not answer for this time is disconnected; 0: never
    double answerWait;   ///< while an agent joins: maximum wait for the others in a cycle
    double joinPace;     ///< minimum duration of a cycle for agents that have not sent a sync predicate yet
  };
  /// Sets the capacity of the budget [s].
  void setBudget(double seconds) { budget_.setCapacity(seconds); }
  /// True if the next cycle may begin. May disconnect agents, or give up waiting for them.
  bool isOpen(const List& participants, const List& newcomers, const Limits& limits, Clock::time_point now);
  /// A cycle begins.
  void beginCycle(Clock::time_point now);
  /// True if the budget is not used up, as of the last wait: then answers count for an agent's trust.
  bool hasBudget() const { return budget_.available(); }

 private:
  double waited(Clock::time_point now) const;
  bool hasAnswered(Participant& p, const Limits& limits, Clock::time_point now, bool anyJoins) const;
  bool isUntrusted(const Participant& p, const Limits& limits, Clock::time_point now) const;
  bool mustPace(const List& participants, const Limits& limits, Clock::time_point now) const;
  bool waitForUntrusted(const List& participants, Clock::time_point now);

  TokenBucket budget_{30, 0.1};       ///< s of waiting; refilled by s per second
  bool waiting_ = false;              ///< isOpen() was called in this cycle
  Clock::time_point waitingSince_{};  ///< when it was called first
  Clock::time_point chargedAt_{};     ///< up to when this cycle's wait was charged; zero: it was not
  Clock::time_point cycleBeganAt_{};
};

}  // namespace spark::gamecontrol
