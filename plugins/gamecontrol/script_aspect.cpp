#include "gamecontrol/script_aspect.h"

#include <utility>

#include "gamecontrol/script_event.h"

namespace spark {

namespace {
constexpr std::string_view kJudge = "judge", kConnected = "agentConnected", kLeaving = "agentLeaving",
                           kRequest = "request", kAction = "action";
}

void ScriptAspect::describe(Description<ScriptAspect>& d) {
  d.doc("A rule written in Lua: its handlers of judge, agentConnected, agentLeaving, request and action.");
  d.implements<IAgentJudge>();
  d.link(&ScriptAspect::simulation_, At<ISimulation>()).doc("The clock of its events.");
  d.method("script", &ScriptAspect::script)
      .parameters({"file", "arguments"})
      .optional(1)
      .doc("Attaches the script, which reads the arguments as `local args = ...`.");
}

void ScriptAspect::onLink() {
  Events& events = kernel().events();
  events.define(kJudge, Order::parentsFirst, "At a ScriptAspect: applies the rule, once in each cycle.");
  events.define(kConnected, Order::parentsFirst, "At a ScriptAspect: an agent has come; data: the path of its aspect.");
  events.define(kLeaving, Order::parentsFirst, "At a ScriptAspect: an agent goes; data: the path of its aspect.");
  events.define(kRequest, Order::parentsFirst,
                "At a ScriptAspect: an agent asks for a perceptor, an effector or a scene file; returns why not.");
  actions_ = &events.define(kAction, Order::parentsFirst, "At a ScriptAspect: an agent acts; returns why it may not.");
}

void ScriptAspect::script(const std::string& file, const Value& arguments) {
  gamecontrol::attachScript(*this, file, arguments);
}

void ScriptAspect::rule(const Event& event) { gamecontrol::askScripts(*this, kJudge, event); }
void ScriptAspect::agentConnected(AgentAspect& agent) { tell(kConnected, agent); }
void ScriptAspect::agentLeaving(AgentAspect& agent) { tell(kLeaving, agent); }

std::string ScriptAspect::judgeRequest(AgentAspect& agent, const PartRequest& request) {
  constexpr const char* kKinds[] = {"perceptor", "effector", "scene"};
  const Value data(List{agent.path(), kKinds[std::size_t(request.kind)], request.type, request.name, request.file});
  return verdict(kRequest, data);
}

std::string ScriptAspect::judgeAction(AgentAspect& agent, const Effector&, const Element& action) {
  if (!actions_ || actions_->empty()) return {};
  const Value data(List{agent.path(), gamecontrol::toValue(action)});
  return verdict(kAction, data);
}

/// All handlers are asked, and one that refuses is enough. A rule that fails grants nothing. A handler that is switched
/// off, as it took too long, counts a fault whenever it is asked, so what it guards stays refused until it is removed.
std::string ScriptAspect::verdict(std::string_view channel, const Value& data) {
  constexpr const char* kFailed = "the rule failed, the log says why";
  const Ref<ScriptAspect> self(this);  // its script may remove it
  Kernel& kernel = this->kernel();
  const std::int64_t faults = kernel.faults();
  const List answers = gamecontrol::askScripts(*this, channel, gamecontrol::eventNow(simulation_.get()), &data);
  if (kernel.faults() != faults) return kFailed;
  for (const Value& answer : answers) {
    if (answer.isNil() || answer.isString()) continue;
    kernel.countFault();
    if (self && !std::exchange(isWrong_, true))
      kernel.log().error("handler of '{}' at {}: {} that says why it refuses. This is logged once.", channel, path(),
                         gamecontrol::reasonOf(answer));
    return kFailed;
  }
  return gamecontrol::reasonOf(answers);
}

void ScriptAspect::tell(std::string_view channel, const AgentAspect& agent) {
  const Value data = agent.path();
  gamecontrol::askScripts(*this, channel, gamecontrol::eventNow(simulation_.get()), &data);
}

}  // namespace spark
