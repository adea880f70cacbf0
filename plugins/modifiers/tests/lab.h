#pragma once
/// \file
/// Agents with imperfect sensors and effectors in a simulation without physics: robots come from a scene file, and
/// behaviors send actions.

#include <string>
#include <vector>

#include "api/modifier.h"
#include "spark/state.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace spark::test {

/// `(C (n name) (v cycle cycle))`: the number of the cycle, from 1, twice.
class CycleSensor : public Perceptor {
  SPARK_CLASS(CycleSensor, Perceptor)
 public:
  static void describe(Description<CycleSensor>& d) { d.doc("Senses the number of the cycle."); }
  void sense(Predicates& out, const Event& event) override {
    const auto cycle = static_cast<double>(event.cycle);
    out.open("C").pair("n", messageName()).open("v").add(cycle).add(cycle).close().close();
  }
};

/// `(name numbers...)`: keeps what it was to do in this cycle.
class Recorder : public Effector {
  SPARK_CLASS(Recorder, Effector)
 public:
  static void describe(Description<Recorder>& d) { d.doc("Keeps its actions."); }
  std::string act(const Element& action) override {
    done.append(action);
    return {};
  }
  Predicates done;
};

/// Sends `next` once.
class Speaker : public Behavior {
  SPARK_CLASS(Speaker, Behavior)
 public:
  static void describe(Description<Speaker>& d) { d.doc("An agent that a test moves."); }
  void start(Predicates& actions) override { readSexp("(scene rsg/agent/robot.rsg)", actions); }
  void think(const Predicates&, Predicates& actions) override {
    if (!next.empty()) readSexp(next, actions);
    next.clear();
  }
  std::string next;
};

class Lab : public TestHost {
 public:
  /// Agents with robots of the scene text `robot`, which is a list of `(nd ...)`. They sense from cycle 3 on, the last
  /// one that the constructor runs.
  explicit Lab(const std::string& robot, int agents = 1, int threads = 1);
  void run(int cycles);
  /// A node of a robot.
  Leaf& part(std::string_view path, int agent = 1);
  /// Runs a cycle. What an agent sensed in it, "" if that is nothing.
  std::string sense(int agent = 1);
  /// What an agent sensed in the last cycle.
  std::string sensed(int agent = 1, int decimals = 2) const;
  /// Runs a cycle in which the first agent decides on its actions, which are executed in the next one. The agent must
  /// sense something. Returns what the Recorder `name` did in this cycle.
  std::string act(const std::string& actions, const char* name = "motor");
  std::string save();
  void load(const std::string& state);
  std::uint64_t hash() { return stateHash(kernel.root()); }

  IGameControl* control = nullptr;
  std::vector<Speaker*> speakers;

 private:
  TemporaryFolder folder_;
};

}  // namespace spark::test
