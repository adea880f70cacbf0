#pragma once
/// \file
/// Joining reproducibly: the clock stands at cycle 0 until the expected agents are there.
///
/// During the hold nothing is made in the tree; messages are parsed and kept. An agent is complete when it has named
/// its robot `(scene ...)` and itself, and has sent `(syn)` with that or later: a `(syn)` still on its way would count
/// as the answer to its first percepts, sometimes. How an agent names itself the game's policy knows (IJoinPolicy); its
/// predicate is `(init ...)` below. Without a policy agents have no names, and `(scene ...)` and `(syn)` are enough.
/// When enough are complete they are ordered by team name and number, then by what they said of their robot, which
/// makes their agents' numbers independent of who came first.
///
/// Clients of a game with a policy differ in what they wait for before they go on:
///
///     all at once        scene, init, syn
///     in turn            scene syn  <- message    init syn
///     step by step       scene      <- message    init       <- message    syn
///     no part in a team  scene syn  <- message    syn        <- message    syn        and never an init
///     one program        agent 1 as above, then agent 2, which comes when agent 1 has been told more
///
/// So a client that named its robot and is silent for a moment gets a minimal message, `(time (now 0.00))`, once after
/// each thing it said, until it is complete; one that answered two of them with `(syn)` and had no `(init ...)` to say
/// needs none. The last kind cannot be helped so: when nothing came from anybody for a while, the match starts with who
/// is there.

#include <memory>
#include <string>
#include <vector>

#include "api/match.h"
#include "gamecontrol/participant.h"

namespace spark::gamecontrol {

class Hold {
 public:
  using List = std::vector<std::unique_ptr<Participant>>;
  /// What ends it. Times are of the wall clock [s].
  struct Terms {
    int agents;         ///< how many are expected
    double greetAfter;  ///< silence after which a client gets a message
    double startAfter;  ///< without progress, after which the match starts with who is there; 0: never
    double reportEvery;
    const IJoinPolicy* policy;  ///< the game's; nullptr: agents have no names
  };
  /// To be called after each message that `p` sent during the hold.
  static void note(Participant& p, const IJoinPolicy* policy);
  /// True when enough of the newcomers (in order of arrival) are complete, or nothing more comes; otherwise greets
  /// those that wait for a message, and says now and then who is waited for.
  bool over(const List& newcomers, const Terms& terms, Log& log);
  /// Puts those with which the match starts to the front, ordered; what they sent after `(scene ...)` is held back
  /// until they were sent their first percepts. Returns how many these are.
  std::size_t order(List& newcomers, int expect, const IJoinPolicy* policy) const;

 private:
  bool isThere(const Participant& p) const;
  void greet(const List& newcomers, double patience, Clock::time_point now) const;
  void noteProgress(const List& newcomers, const IJoinPolicy* policy, Clock::time_point now);
  void report(const List& newcomers, const Terms& terms, Clock::time_point now, Log& log);

  int reported_ = -1, furthest_ = -1;
  bool givenUp_ = false;  ///< the match starts with who is there
  Clock::time_point progressAt_{}, reportedAt_{};
};

}  // namespace spark::gamecontrol
