#include "gamecontrol/script_effector.h"

#include "gamecontrol/script_event.h"

namespace spark {

namespace {
constexpr std::string_view kPerform = "perform";

/// The action as a value. Languages without types send numbers as words.
Value toValue(const Element& e) {
  if (e.isList()) {
    List out;
    for (const Element inner : e) out.push_back(toValue(inner));
    return out;
  }
  if (e.token().kind == Token::Kind::integer) return e.token().integer;
  const std::optional<double> number = e.token().quoted ? std::nullopt : e.asNumber();
  return number ? Value(*number) : Value(e.text());
}
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
  const Value data = toValue(action);
  const Value answer = gamecontrol::askScripts(*this, kPerform, gamecontrol::eventNow(simulation_.get()), &data);
  return gamecontrol::reasonOf(answer);
}

}  // namespace spark
