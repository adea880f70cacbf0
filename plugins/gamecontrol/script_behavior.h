#pragma once
/// \file
/// An agent's behavior as a Lua script.

#include "api/agents.h"
#include "spark/describe.h"

namespace spark {

/// Runs the handlers of a script: `start` once, `think` for the percepts of each cycle (`event.data`: nested lists). A
/// handler sets the property `actions` to S-expressions, which the agent executes.
class ScriptBehavior : public Behavior {
  SPARK_CLASS(ScriptBehavior, Behavior)
 public:
  static void describe(Description<ScriptBehavior>& d);
  void start(Predicates& actions) override;
  void think(const Predicates& percepts, Predicates& actions) override;

 protected:
  void onLink() override;

 private:
  /// Attaches a script; its `...` is `arguments`. Throws Error if it cannot be loaded.
  void script(const std::string& file, const Value& arguments);
  void run(std::string_view channel, const Value* data, Predicates& actions);
  Link<ISimulation> simulation_;
  std::string actions_;
};

}  // namespace spark
