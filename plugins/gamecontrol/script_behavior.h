#pragma once
/// \file
/// A behaviour written in Lua.

#include "api/agents.h"
#include "spark/describe.h"

namespace spark {

/// Runs a script's handlers: `start` once, `think` for each cycle's percepts (`event.data`: nested lists). What the
/// script leaves in the property `actions`, S-expressions, is done.
class ScriptBehavior : public Behavior {
  SPARK_CLASS(ScriptBehavior, Behavior)
 public:
  static void describe(Description<ScriptBehavior>& d);
  void start(Predicates& actions) override;
  void think(const Predicates& percepts, Predicates& actions) override;

 protected:
  void onLink() override;

 private:
  void script(std::string file, Value arguments);
  void run(std::string_view channel, const Value* data, Predicates& actions);
  std::string actions_;
};

}  // namespace spark
