#include "gamecontrol/script_behavior.h"

#include "gamecontrol/script_event.h"
#include "spark/read_message.h"

namespace spark {

void ScriptBehavior::describe(Description<ScriptBehavior>& d) {
  d.doc("A behaviour written in Lua: handles start and think, sets actions to S-expressions.");
  d.link(&ScriptBehavior::simulation_, At<ISimulation>()).doc("The clock of its events.");
  d.property("actions", &ScriptBehavior::actions_)
      .state()
      .doc("The agent's next actions: S-expressions, set by the script's handlers.");
  d.method("script", &ScriptBehavior::script)
      .parameters({"file", "arguments"})
      .optional(1)
      .doc("Attaches the script, which reads the arguments as `local args = ...`.");
}

void ScriptBehavior::onLink() {
  kernel().events().define("start", Order::parentsFirst, "At a ScriptBehavior: its agent joins.");
  kernel().events().define("think", Order::parentsFirst, "At a ScriptBehavior: its percepts came.");
}

void ScriptBehavior::script(const std::string& file, const Value& arguments) {
  gamecontrol::attachScript(*this, file, arguments);
}

void ScriptBehavior::start(Predicates& actions) { run("start", nullptr, actions); }

void ScriptBehavior::think(const Predicates& percepts, Predicates& actions) {
  const Value data(toList(percepts));
  run("think", &data, actions);
}

void ScriptBehavior::run(std::string_view channel, const Value* data, Predicates& actions) {
  actions_.clear();
  Event event = gamecontrol::eventNow(simulation_.get());
  event.name = channel;
  event.data = data;
  const Ref<ScriptBehavior> self(this);  // its script may delete it
  kernel().events().channel(channel).emitAt(*this, event);
  if (!self) return;
  const ReadResult result = readMessage(actions_, actions);
  if (!result.message.empty())
    kernel().log().warning("{}.actions: {} at {}:{}.", path(), result.message, result.line, result.column);
}

}  // namespace spark
