#pragma once
/// \file
/// How long agents think, in simulated time.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "agent_mind.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {
namespace spades {

/// A number of steps for what an agent has used.
struct ThinkModel {
  std::optional<Time> fixed = 0;  ///< always as many steps; nullopt: measured
  double secondsPerStep = 0.01;   ///< CPU time of a step, measured

  /// Shortest think time [steps]: before it no act can come.
  Time least() const { return fixed ? *fixed : 1; }
  /// Steps for a CPU time [s].
  Time thought(double cpuSeconds) const {
    if (fixed) return *fixed;
    return std::max<Time>(1, static_cast<Time>(std::ceil(std::min(cpuSeconds / secondsPerStep, 1e9))));
  }
};

/// The model that a timer of the agent database names: "fixed 3", "jiffies 2000" (CPU microseconds per step; the same
/// for perfctr). nullopt for "" and "default". Throws Error for another text.
std::optional<ThinkModel> readTimer(std::string_view timer);

}  // namespace spades

/// Base of the models of think time, children of the SpadesServer.
class ThinkTime : public Leaf {
  SPARK_CLASS(ThinkTime, Leaf)
 public:
  static void describe(Description<ThinkTime>& d) {
    d.doc("How long agents think, in simulated time.");
    d.abstract();
  }
  virtual spades::ThinkModel model() const = 0;
};

/// The same time for every thought: results depend on nothing but the agents' messages.
class FixedThinkTime : public ThinkTime {
  SPARK_CLASS(FixedThinkTime, ThinkTime)
 public:
  static void describe(Description<FixedThinkTime>& d) {
    d.doc("Each thought takes the same simulated time: a match is repeatable to the last bit.");
    d.property("steps", &FixedThinkTime::steps_)
        .unit("steps")
        .range(0, 1000)
        .doc("Duration of a thought, in steps of the simulation.");
  }
  spades::ThinkModel model() const override { return {steps_, 0}; }

 private:
  int steps_ = 3;
};

/// The CPU time that the agent's program used, whatever else the machine does. Not repeatable to the last bit: CPU time
/// varies with caches and the clock of the processor.
class CpuThinkTime : public ThinkTime {
  SPARK_CLASS(CpuThinkTime, ThinkTime)
 public:
  static void describe(Description<CpuThinkTime>& d) {
    d.doc("A thought takes as many steps as the agent's program used CPU time, at least one.");
    d.property("perStep", &CpuThinkTime::perStep_)
        .unit("s")
        .range(1e-6, 10)
        .doc("CPU time of the agent that counts as one step; a part of it counts as a whole one.");
  }
  spades::ThinkModel model() const override { return {std::nullopt, perStep_}; }

 private:
  double perStep_ = 0.01;
};

}  // namespace spark
