#pragma once
/// \file
/// Reproducible joining: the clock stays at cycle 0 until the expected agents are ready.
///
/// During the hold nothing is created in the tree; messages are parsed and kept. An agent is complete when it has sent
/// `(scene ...)`, which names its robot, its identity, and `(syn)` in the same message as these or later: a `(syn)`
/// that is still in the network at the start could count as the answer to the first percepts. The game's IJoinPolicy
/// knows how an agent states its identity; below that predicate is `(init ...)`. Without a policy agents have no
/// identity, and `(scene ...)` and `(syn)` are enough; an agent whose robot a rule makes owes neither. When enough
/// agents are complete, they are ordered by team name and number, then by their `(scene ...)`, so that their numbers do
/// not depend on the order of arrival.
///
/// Clients of a game with a policy differ in what they wait for before they continue:
///
///     all at once        scene, init, syn
///     in turn            scene syn  <- message    init syn
///     step by step       scene      <- message    init       <- message    syn
///     without a team     scene syn  <- message    syn        <- message    syn        and never an init
///     one program        agent 1 as above, then agent 2, which connects when agent 1 has got more messages
///     without a policy   <- message    anything but a scene: a rule makes the robot
///
/// So a client that has sent `(scene ...)`, or need not, and is silent for a moment gets a minimal message, `(time (now
/// 0.00))`, once after each of its messages, until it is complete. One that has answered two of them with `(syn)` and
/// without `(init ...)` is complete, too. For clients of one program this is not enough: when no agent has made
/// progress for a while, the match starts with those that are ready.

#include <memory>
#include <string>
#include <vector>

#include "api/match.h"
#include "gamecontrol/participant.h"

namespace spark::gamecontrol {

class Hold {
 public:
  using List = std::vector<std::unique_ptr<Participant>>;
  /// When the hold ends. Times are wall time in seconds.
  struct Terms {
    int agents;                 ///< number of expected agents
    double greetAfter;          ///< silence after which a client gets a message
    double startAfter;          ///< time without progress after which the match starts anyway; 0: never
    double reportEvery;         ///< between two log lines
    const IJoinPolicy* policy;  ///< the game's; nullptr: agents have no identity
    Clock::time_point now;      ///< what was sent until then has been received
  };
  /// Updates Participant::held(). Call it after each message of `p` during the hold.
  static void onMessage(Participant& p, const IJoinPolicy* policy);
  /// True if the match can start: enough newcomers are complete, or there was no progress for `startAfter`. Otherwise
  /// greets clients that wait for a message, and logs from time to time what is missing. `newcomers`: in order of
  /// arrival.
  bool isOver(const List& newcomers, const Terms& terms, Log& log);
  /// Moves the agents with which the match starts to the front and orders them. Their actions other than `(scene ...)`
  /// are held back until the first percepts were sent.
  void orderNewcomers(List& newcomers, int expect, const IJoinPolicy* policy) const;

 private:
  bool isReady(const Participant& p, const IJoinPolicy* policy) const;
  void greetSilent(const List& newcomers, const Terms& terms, Clock::time_point now) const;
  void updateProgress(const List& newcomers, const IJoinPolicy* policy, Clock::time_point now);
  void report(const List& newcomers, const Terms& terms, Clock::time_point now, Log& log);

  int complete_ = -1;      ///< number of complete agents, as logged last; -1: not yet
  int progress_ = -1;      ///< the maximum of what updateProgress() counts
  bool timedOut_ = false;  ///< the match starts without all expected agents
  Clock::time_point progressAt_{}, reportedAt_{};
};

}  // namespace spark::gamecontrol
