#pragma once
/// \file
/// A rule written in Lua.

#include "api/agents.h"
#include "spark/describe.h"

namespace spark {

/// Its script's handlers are the rule: `judge` runs once in each cycle while the aspect is enabled, `agentConnected`
/// and `agentLeaving` when an agent comes and goes. Their `event.data` is the path of the agent's aspect. `request`
/// runs when an agent asks for a perceptor, an effector or a scene file; `event.data` is { path of the agent's aspect,
/// "perceptor", class, name, file }, and a text that it returns refuses the request; `file` is the scene file that the
/// part comes with, or "". `action` runs when an agent acts; `event.data` is { path of the agent's aspect, action },
/// and a text that it returns refuses the action. All handlers are asked, and one that refuses is enough. Without a
/// verdict, as a script failed or returned something else, what it judges is refused, until the handler that fails is
/// removed or replaced.
class ScriptAspect : public ControlAspect, public IAgentJudge {
  SPARK_CLASS(ScriptAspect, ControlAspect)
 public:
  static void describe(Description<ScriptAspect>& d);
  void rule(const Event& event) override;
  void agentConnected(AgentAspect& agent) override;
  void agentLeaving(AgentAspect& agent) override;
  std::string judgeRequest(AgentAspect& agent, const PartRequest& request) override;
  std::string judgeAction(AgentAspect& agent, const Effector& effector, const Element& action) override;

 protected:
  void onLink() override;

 private:
  void script(const std::string& file, const Value& arguments);
  void tell(std::string_view channel, const AgentAspect& agent);
  /// Why the handlers of `channel` refuse, or "".
  std::string verdict(std::string_view channel, const Value& data);

  Link<ISimulation> simulation_;
  Channel* actions_ = nullptr;  ///< of `action`
  bool isWrong_ = false;        ///< it has returned what is no verdict
};

}  // namespace spark
