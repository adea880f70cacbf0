#pragma once

#include "soccer_control_aspect.h"

namespace spark {

/// Robots without a team touch the ground only: they are created at one spot, inside of each other, and would burst
/// apart.
class TeamlessAspect : public SoccerControlAspect {
  SPARK_CLASS(TeamlessAspect, SoccerControlAspect)
 public:
  static void describe(Description<TeamlessAspect>& d) {
    d.doc("Robots without a team touch only what does not move.");
  }
  void agentConnected(AgentAspect& agent) override { detach(agent.create(kGroup, kGroup), enabled()); }
  void rule(const Event&) override { follow(); }
  void rest(const Event&) override { follow(); }

 protected:
  void loadState(StateReader&) override { tree_.lookAgain(); }

 private:
  static constexpr const char *kGroup = "CollisionGroup", *kDetached = "detached";
  struct Robot {
    const AgentState* state;  ///< nullptr: no robot, or one that cannot be in a team
    Leaf* group;
    bool detached;
  };
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
  std::vector<Robot> robots_;  ///< as of the last change of the tree
};

}  // namespace spark
