#pragma once
/// \file
/// Lockstep: when the next cycle may begin.
///
/// The gate waits for agents that have sent a sync predicate before and were sent percepts since, until syncTimeout.
/// Before its first sync predicate an agent is waited for as long as it has answered every message, for answerWait and
/// once more answerWait for each answer, half as long for each agent that did not answer: what a client gets while it
/// joins does not depend on how fast it is, and one that never answers costs one answerWait. It does not wait for
/// others: an idle connection, or a client that sends (syn) only when all of its team have joined, must not stop the
/// match.
///
/// Some clients answer with several messages: (init ...), (syn), (syn). Until its first cycle with a sync predicate is
/// over an agent has answered when it has been silent for joinPace.
///
/// An agent that has not answered for five times answerWait is closed if another client claims its name: that one is
/// its successor, and the match does not wait for syncTimeout.
///
/// A time-out counts until the last look only: what a client sent until then has been received. So no client pays for
/// the time in which the host itself did not run.
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
    double syncTimeout;             ///< an agent that does not answer for this time is disconnected; 0: never
    double answerWait;              ///< while an agent joins: maximum wait for the others in a cycle
    double joinPace;                ///< minimum duration of a cycle for agents that have not sent a sync predicate yet
    IJoinPolicy* policy = nullptr;  ///< the game's
  };
  /// Two readings of the clock.
  struct Look {
    Clock::time_point now;
    Clock::time_point last;  ///< when input was about to be read last: what has not come was not sent by then
  };
  /// Sets the capacity of the budget [s].
  void setBudget(double seconds) { budget_.setCapacity(seconds); }
  /// True if the next cycle may begin. May disconnect agents, or give up waiting for them.
  bool isOpen(const List& participants, const List& newcomers, const Limits& limits, Look look, AgentLog& log);
  /// A cycle begins.
  void beginCycle(Clock::time_point now);
  /// True if the budget is not used up, as of the last wait: then answers count for an agent's trust.
  bool hasBudget() const { return budget_.available(); }

 private:
  double waited(Clock::time_point last) const;
  bool hasAnswered(Participant& p, const List& participants, const Limits& limits, Clock::time_point last,
                   bool anyJoins, int lapsed, AgentLog& log) const;
  double patience(const Participant& p, const Limits& limits, bool anyJoins, int lapsed) const;
  bool isUntrusted(const Participant& p, const Limits& limits, Clock::time_point last) const;
  bool mustPace(const List& participants, const Limits& limits, Clock::time_point last) const;
  bool waitForUntrusted(const List& participants, Look look);

  TokenBucket budget_{30, 0.1};       ///< s of waiting; refilled by s per second
  bool waiting_ = false;              ///< isOpen() was called in this cycle
  Clock::time_point waitingSince_{};  ///< when it was called first
  Clock::time_point chargedAt_{};     ///< up to when this cycle's wait was charged; zero: it was not
  Clock::time_point cycleBeganAt_{};
};

}  // namespace spark::gamecontrol
