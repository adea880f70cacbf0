#pragma once
/// \file
/// The agents of game control: in order of number, by number, path and aspect.

#include <vector>

#include "api/agents.h"
#include "gamecontrol/participant.h"
#include "gamecontrol/vacancies.h"

namespace spark::gamecontrol {

/// The agents among the participants, without rules. An aspect may be removed from the tree at any time: until the next
/// act phase removes its agent, the agent exists, but is not listed. Simulation thread.
class AgentList {
 public:
  /// `participants`, in order of number, must outlive the list.
  explicit AgentList(const Participants& participants) : participants_(participants) {}
  /// All of them. `control`: game control. Valid until an agent is added or removed.
  const std::vector<AgentAspect*>& all(const Node& control) const;
  /// Their paths.
  List paths(const Node& control) const;
  /// The agent with that number or path. Throws Error with those that there are.
  AgentAspect& at(const Value& agent, const Node& control) const;
  /// The agent, or the rule, with that aspect; nullptr if there is none.
  Participant* of(const AgentAspect& aspect) const;
  /// Participants were added or removed.
  void lookAgain() { tree_.lookAgain(); }
  /// Forgets all.
  void clear() { agents_.clear(); }

 private:
  const Participants& participants_;
  mutable std::vector<AgentAspect*> agents_;  ///< a cache that all() updates
  mutable TreeWatch tree_;
};

}  // namespace spark::gamecontrol
