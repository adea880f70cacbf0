#pragma once
/// \file
/// The rules that judge what agents ask for and do.

#include <string>
#include <vector>

#include "api/agents.h"
#include "spark/link.h"

namespace spark::gamecontrol {

/// Asks judges (IAgentJudge) one after the other. A judge may be a script that removes others, the effector that is
/// judged, or the agent. Simulation thread.
class JudgeList {
 public:
  /// Takes the judges of `links`, without control aspects that are disabled.
  void update(const Links<IAgentJudge>& links);
  /// True if there are none.
  bool empty() const { return judges_.empty(); }
  /// IAgentJudge::judgeRequest() of all of them, also of those after one that refuses: "", or the first reason.
  std::string judgeRequest(AgentAspect& agent, const PartRequest& request) const;
  /// IAgentJudge::judgeAction() of one after the other, until one refuses.
  std::string judgeAction(AgentAspect& agent, Effector& effector, const Element& action) const;

 private:
  struct Judge {
    Ref<Leaf> leaf;
    IAgentJudge* judge;  ///< while `leaf` exists
  };
  std::vector<Judge> judges_;
};

}  // namespace spark::gamecontrol
