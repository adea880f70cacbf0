#pragma once
/// \file
/// Joining reproducibly: the clock stands at cycle 0 until the expected agents are there.
///
/// During the hold nothing is made in the tree; messages are parsed and kept. An agent is complete when it has named its robot `(scene ...)`,
/// its team and number `(init ...)`, and has sent `(syn)` with that or later: a `(syn)` still on its way would count as the answer to its
/// first percepts, sometimes. Clients that wait for a first message before they say who they are get a minimal
/// one, `(time (now 0.00))`, once they have named a robot and been silent for a moment. When enough are complete they are ordered by team
/// name and number, which makes their agents' numbers independent of who came first.

#include <memory>
#include <vector>

#include "gamecontrol/participant.h"

namespace spark::gamecontrol {

class Hold {
 public:
  using List = std::vector<std::unique_ptr<Participant>>;
  /// To be called after each message that `p` sent during the hold.
  static void note(Participant& p);
  /// True when `expect` of the newcomers (in order of arrival) are complete; otherwise greets those that wait longer than `patience` [s].
  bool over(const List& newcomers, int expect, double patience, Log& log);
  /// Puts the first `expect` complete ones to the front, ordered; what they sent after `(scene ...)` is held back until they were sent
  /// their first percepts. Returns how many these are.
  static std::size_t order(List& newcomers, int expect);

 private:
  int reported_ = -1;
};

}  // namespace spark::gamecontrol
