#include "gamecontrol/judge_list.h"

namespace spark::gamecontrol {

void JudgeList::update(const Links<IAgentJudge>& links) {
  judges_.clear();
  for (const Found<IAgentJudge>& judge : links) {
    const auto rule = judge.leaf->as<ControlAspect>();
    if (!rule || rule->enabled()) judges_.push_back({judge.leaf, judge.object});
  }
}

std::string JudgeList::judgeRequest(AgentAspect& agent, const PartRequest& request) const {
  const Ref<AgentAspect> asking(&agent);
  const Ref<Node> parent(&request.parent);
  std::string first;
  for (const Judge& j : judges_) {
    if (!j.leaf) continue;
    std::string why = j.judge->judgeRequest(agent, request);
    if (first.empty()) first = std::move(why);
    if (!asking || !parent) return first.empty() ? "the place of the new node was removed" : first;
  }
  return first;
}

std::string JudgeList::judgeAction(AgentAspect& agent, Effector& effector, const Element& action) const {
  const Ref<AgentAspect> acting(&agent);
  const Ref<Effector> judged(&effector);
  for (const Judge& j : judges_) {
    if (!j.leaf) continue;
    if (std::string why = j.judge->judgeAction(agent, effector, action); !why.empty()) return why;
    if (!acting || !judged) return "the effector was removed";
  }
  return {};
}

}  // namespace spark::gamecontrol
