#pragma once
/// \file
/// Rules about what agents ask for and do, for any game.

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "api/agents.h"

namespace spark {

/// Decides which perceptors, effectors and scene files agents may ask for, the files of their robots among them; agents
/// that ask for others too often are disqualified. A file that is not listed itself is granted if something is listed,
/// and so are all perceptors and effectors that it brings.
class RequestAspect : public ControlAspect, public IAgentJudge {
  SPARK_CLASS(RequestAspect, ControlAspect)
 public:
  static void describe(Description<RequestAspect>& d) {
    using R = RequestAspect;
    d.doc("Decides what agents may ask for, and disqualifies those that ask for something else too often.");
    d.implements<IAgentJudge>();
    d.property("allowed", &R::allowed_)
        .doc(
            "Classes and scene files that are granted, also with (scene <file>); all others are refused. A file that "
            "is not listed needs all its perceptors and effectors listed.");
    d.property("tolerance", &R::tolerance_)
        .min(-1)
        .doc("Refused requests after which an agent's next one disqualifies it; -1: never.");
  }
  void rule(const Event&) override {}
  void agentLeaving(AgentAspect& agent) override { refused_.erase(agent.number()); }
  std::string judgeRequest(AgentAspect& agent, const PartRequest& request) override {
    if (allows(request.type) || (!request.file.empty() && allows(request.file))) return {};
    if (request.kind == PartRequest::Kind::scene && !allowed_.empty()) return {};  // its parts decide
    std::string why = "the rules do not allow " + std::string(request.type);
    if (!request.file.empty()) why += " in " + std::string(request.file);
    if (tolerance_ >= 0 && ++refused_[agent.number()] > tolerance_)
      if (auto* control = find<IGameControl>(IGameControl::kPath))
        control->disqualify(agent, "it asked again for what the rules do not allow, " + std::string(request.type));
    return why;
  }

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  bool allows(std::string_view what) const {
    return std::find(allowed_.begin(), allowed_.end(), what) != allowed_.end();
  }
  std::vector<std::string> allowed_;
  int tolerance_ = -1;
  std::map<int, int> refused_;  ///< number of refused requests by number of the agent
};

/// Limits how often in a cycle an agent may use an effector, such as one dash a cycle. Further actions are refused.
class ActionLimitAspect : public ControlAspect, public IAgentJudge {
  SPARK_CLASS(ActionLimitAspect, ControlAspect)
 public:
  static void describe(Description<ActionLimitAspect>& d) {
    using A = ActionLimitAspect;
    d.doc("Limits how often in a cycle an agent may use an effector.");
    d.implements<IAgentJudge>();
    d.property("predicate", &A::predicate_).doc("Predicate of the effector, such as drive.");
    d.property("perCycle", &A::perCycle_).min(0).doc("Number of actions in one cycle; further ones are refused.");
  }
  void rule(const Event&) override { used_.clear(); }
  void rest(const Event&) override { used_.clear(); }
  std::string judgeAction(AgentAspect& agent, const Effector&, const Element& action) override {
    if (action.head() != predicate_) return {};
    const auto at = static_cast<std::size_t>(agent.number());
    if (used_.size() <= at) used_.resize(at + 1, 0);
    if (++used_[at] <= perCycle_) return {};
    return "the rules allow " + std::to_string(perCycle_) + " a cycle";
  }

 private:
  std::string predicate_;
  int perCycle_ = 1;
  std::vector<int> used_;  ///< in this cycle, by number of the agent
};

}  // namespace spark
