#pragma once
/// \file
/// The time of agents as the middleware SPADES has it: each senses at its own times.

#include <algorithm>

#include "api/agents.h"

namespace spark {

/// A child of game control: agent k of n, counted from 0, senses first in cycle int(1 + k interval / n), and then every
/// `interval` cycles. So the agents of a match sense at different times. Source: Spark's server for SPADES, 2004.
class SenseSchedule : public Leaf, public IAgentTiming {
  SPARK_CLASS(SenseSchedule, Leaf)
 public:
  static void describe(Description<SenseSchedule>& d) {
    d.doc("Each agent senses every `interval` cycles, and not at the same time as others.");
    d.implements<IAgentTiming>();
    d.property("interval", &SenseSchedule::interval_)
        .unit("cycles")
        .range(1, 10000)
        .doc("Time between two sensations of an agent.");
    d.property("agents", &SenseSchedule::agents_)
        .range(1, 1000)
        .doc("Number of agents among which the interval is divided; 1: all sense in the same cycles.");
  }
  bool sendsEmpty() const override { return true; }
  /// Nothing is under way in game control: SpadesServer knows how long an agent thinks, and keeps its messages.
  AgentLatencies latencies(const AgentAspect&) const override { return {.sense = 0, .act = 0}; }
  bool senses(const AgentAspect& agent, std::int64_t cycle) const override {
    const std::int64_t k = std::max(agent.number() - 1, 0);
    return (cycle - 1 - k * interval_ / agents_) % interval_ == 0;
  }

 private:
  int interval_ = 20, agents_ = 1;
};

}  // namespace spark
