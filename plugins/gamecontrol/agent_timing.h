#pragma once
/// \file
/// The time of agents in the plain run loop: turns and latencies.

#include "api/agents.h"

namespace spark {

/// A child of AgentTiming: the latencies of one agent, in place of those of all.
class AgentLatency : public Leaf {
  SPARK_CLASS(AgentLatency, Leaf)
 public:
  static void describe(Description<AgentLatency>& d);
  /// The agent's number, from 1.
  int agent() const { return agent_; }
  AgentLatencies latencies() const { return {senseLatency_, actLatency_}; }

 private:
  int agent_ = 1, senseLatency_ = 1, actLatency_ = 0;
};

/// A child of game control: all agents act and sense in the same cycles, and their messages are under way for a number
/// of cycles.
class AgentTiming : public Node, public IAgentTiming {
  SPARK_CLASS(AgentTiming, Node)
 public:
  static void describe(Description<AgentTiming>& d);

  int cyclesToNextTurn(double step) const override;
  AgentLatencies latencies(const AgentAspect& agent) const override;

 private:
  int senseLatency_ = 1, actLatency_ = 0;
  double agentStep_ = 0;
  Links<AgentLatency> own_;
};

}  // namespace spark
