#pragma once

#include "soccer_control_aspect.h"

namespace spark {

/// Robots without a team collide with static colliders only. They are all created at the same position, inside each
/// other, and would burst apart otherwise.
class TeamlessAspect : public SoccerControlAspect {
  SPARK_CLASS(TeamlessAspect, SoccerControlAspect)
 public:
  static void describe(Description<TeamlessAspect>& d) {
    d.doc("Robots without a team collide with static colliders only.");
  }
  void agentConnected(AgentAspect& agent) override { detach(agent.create(kGroup, kGroup), enabled()); }
  void rule(const Event&) override { follow(); }
  void rest(const Event&) override { follow(); }

 protected:
  void loadState(StateReader&) override { tree_.lookAgain(); }

 private:
  static constexpr const char *kGroup = "CollisionGroup", *kDetached = "detached";
  struct Robot {
    const AgentState* state;  ///< nullptr: no robot yet, or not that of a player
    Leaf* group;              ///< the collision group of the agent
    bool detached;
  };
  /// Detaches the robots without a team, and attaches those that have joined one.
  void follow() {
    if (tree_.changed(*this)) lookUp();
    for (Robot& r : robots_)
      if (const bool wanted = enabled() && isTeamless(r); wanted != r.detached) detach(*r.group, r.detached = wanted);
  }
  static bool isTeamless(const Robot& r) { return !r.state || r.state->side() == soccer::Side::none; }
  static void detach(Leaf& group, bool on) { setProperty(group, kDetached, on); }
  void lookUp() {
    robots_.clear();
    const auto control = parent()->as<IGameControl>();
    if (!control) return;
    for (AgentAspect* agent : control->agents()) {
      std::vector<AgentState*> states;
      agent->collect(states);
      if (Leaf* group = agent->find(kGroup))
        robots_.push_back({states.empty() ? nullptr : states.front(), group, getProperty(*group, kDetached).toBool()});
    }
  }

  TreeWatch tree_;
  std::vector<Robot> robots_;  ///< of all agents, as of the last change of the tree
};

}  // namespace spark
