#include "gamecontrol/script_effector.h"

#include "gamecontrol/script_event.h"

namespace spark {

namespace {
constexpr std::string_view kPerform = "perform";
}  // namespace

void ScriptEffector::describe(Description<ScriptEffector>& d) {
  d.doc("An effector written in Lua: its handler of perform executes the actions that begin with its name.");
  d.link(&ScriptEffector::simulation_, At<ISimulation>()).doc("The clock of its events.");
  d.method("script", &ScriptEffector::script)
      .parameters({"file", "arguments"})
      .optional(1)
      .doc("Attaches the script, which reads the arguments as `local args = ...`.");
}

void ScriptEffector::onLink() {
  kernel().events().define(kPerform, Order::parentsFirst,
                           "At a ScriptEffector: executes the action, returns what is wrong with it.");
}

void ScriptEffector::script(const std::string& file, const Value& arguments) {
  gamecontrol::attachScript(*this, file, arguments);
}

std::string ScriptEffector::act(const Element& action) {
  const Value data = gamecontrol::toValue(action);
  return gamecontrol::reasonOf(
      gamecontrol::askScripts(*this, kPerform, gamecontrol::eventNow(simulation_.get()), &data));
}

}  // namespace spark
