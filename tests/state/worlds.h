#pragma once
/// \file
/// Worlds that only the test drives. Two worlds that are built in the same way and get the same inputs behave
/// identically.

#include <functional>
#include <string>
#include <vector>

#include "api/agents.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

/// A player without internal state. It executes the actions in `next` once.
class ScriptedPlayer : public Behavior {
  SPARK_CLASS(ScriptedPlayer, Behavior)
 public:
  static void describe(Description<ScriptedPlayer>& d) { d.doc("A player that a test moves."); }
  void start(Predicates& actions) override { readSexp("(scene " + robot + ")", actions); }
  void think(const Predicates&, Predicates& actions) override {
    readSexp(next, actions);
    next.clear();
  }
  std::string robot;
  std::string next;  ///< S-expressions
};

class World : public TestHost {
 public:
  using Settings = std::vector<std::pair<std::string, Value>>;

  /// Makes the world of one of Spark's configs, without sockets.
  void configure(const std::string& config, const Settings& settings);
  /// Makes the world of a config that is given as text.
  void configureByText(const std::string& text);
  Leaf& at(std::string_view path) { return kernel.root().require<Leaf>(path); }
  /// Adds a player with a robot to a team. This takes some cycles.
  ScriptedPlayer& join(const std::string& team, int unum, const std::string& robot);
  ScriptedPlayer& player(std::size_t i) { return *players_.at(i); }
  /// Executes trainer commands at once.
  void trainer(const std::string& commands);
  void cycle() { cycles(1); }
  void cycles(int count);
  std::string saved();
  void load(const std::string& state);
  std::uint64_t hash() { return stateHash(kernel.root()); }

 private:
  void prepare();
  void finish();
  std::vector<ScriptedPlayer*> players_;
};

/// A kind of world: how it is made, and its inputs before each cycle.
struct Scenario {
  const char* name;
  std::function<void(World&)> make;
  std::function<void(World&, int cycle)> input;
  int cycles;
};

/// All scenarios.
const std::vector<Scenario>& scenarios();

}  // namespace spark::test
