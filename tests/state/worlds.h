#pragma once
/// \file
/// Worlds that are made and moved by scripts of the test alone: built twice and given the same inputs, they do the
/// same.

#include <functional>
#include <string>
#include <vector>

#include "api/agents.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

/// A player without memory: does once what the script wrote into `next`.
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

class World : public House {
 public:
  using Settings = std::vector<std::pair<std::string, Value>>;

  /// Makes the world of one of Spark's configs, without sockets.
  void configure(const std::string& config, const Settings& settings);
  /// Makes the world that a Lua text describes.
  void configureByText(const std::string& text);
  Leaf& at(std::string_view path) { return kernel.root().require<Leaf>(path); }
  /// A player of a team with that robot; takes some cycles.
  ScriptedPlayer& join(const std::string& team, int unum, const std::string& robot);
  ScriptedPlayer& player(std::size_t i) { return *players_.at(i); }
  /// A trainer's commands, which act at once.
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

/// A kind of world: how it is made, and what comes from outside before each cycle.
struct Scenario {
  const char* name;
  std::function<void(World&)> make;
  std::function<void(World&, int cycle)> input;
  int cycles;
};

/// All of them.
const std::vector<Scenario>& scenarios();

}  // namespace spark::test
