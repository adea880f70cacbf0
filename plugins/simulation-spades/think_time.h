#pragma once
/// \file
/// How long agents think, in simulated time.

#include <optional>
#include <string_view>

#include "agent_mind.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {
namespace spades {

/// The model that a timer of the agent database names: "fixed 3", "jiffies 2000" (CPU microseconds per step),
/// "instructions 10000000" (per step). "perfctr 2000" and "perfctr_instr 2000" are the same as "jiffies 2000": what
/// their numbers counted is not known, and a database should mean the same on each machine. nullopt for "" and
/// "default". Throws Error for another text.
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

/// The instructions that the agent's program retired. They depend less on caches and on the clock of the processor than
/// CPU time does, but on the processor's counters, which most virtual machines lack. They vary
/// by little, not by nothing: it is not repeatable to the last bit.
class InstructionThinkTime : public ThinkTime {
  SPARK_CLASS(InstructionThinkTime, ThinkTime)
 public:
  static void describe(Description<InstructionThinkTime>& d) {
    d.doc("A thought takes as many steps as the agent's program retired instructions, at least one.");
    d.property("perStep", &InstructionThinkTime::perStep_)
        .unit("instructions")
        .range(1e3, 1e12)
        .doc("Instructions of the agent that count as one step; a part of them counts as a whole one.");
  }
  spades::ThinkModel model() const override { return {std::nullopt, perStep_, true}; }

 private:
  double perStep_ = 1e7;
};

}  // namespace spark
