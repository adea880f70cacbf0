#pragma once
/// \file
/// An effector written in Lua.

#include "api/agents.h"
#include "spark/describe.h"

namespace spark {

/// Its script's handler of `perform` executes the actions that begin with the effector's name, when they come, in the
/// act phase. `event.data` is the action, `{"push", 1, 0.5}`: words that are numbers are numbers. It returns nothing,
/// or one line that says what was expected and what was found, for the agent's log.
class ScriptEffector : public Effector {
  SPARK_CLASS(ScriptEffector, Effector)
 public:
  static void describe(Description<ScriptEffector>& d);
  std::string act(const Element& action) override;

 protected:
  void onLink() override;

 private:
  void script(const std::string& file, const Value& arguments);

  Link<ISimulation> simulation_;
};

}  // namespace spark
