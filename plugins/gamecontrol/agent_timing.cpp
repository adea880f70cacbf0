#include "gamecontrol/agent_timing.h"

#include <algorithm>
#include <cmath>

namespace spark {

namespace {
constexpr int kMostLatency = 1000;  // cycles; messages under way take memory

/// The two properties that the classes here share.
template <class T>
void describeLatencies(Description<T>& d, int T::*sense, int T::*act) {
  d.property("senseLatency", sense)
      .unit("cycles")
      .range(0, kMostLatency)
      .doc("Time from sensing to the arrival of the percepts; SimSpark has 1.");
  d.property("actLatency", act)
      .unit("cycles")
      .range(0, kMostLatency)
      .doc("Time by which actions take effect later than without latency.");
}
}  // namespace

void AgentLatency::describe(Description<AgentLatency>& d) {
  using A = AgentLatency;
  d.doc("Latencies of one agent; a child of AgentTiming, whose own are those of all others.");
  d.property("agent", &A::agent_).min(1).doc("The agent's number.");
  describeLatencies(d, &A::senseLatency_, &A::actLatency_);
}

void AgentTiming::describe(Description<AgentTiming>& d) {
  using A = AgentTiming;
  d.doc("When agents act and sense, when their percepts arrive and when their actions take effect.");
  d.implements<IAgentTiming>();
  d.link(&A::own_, Child<AgentLatency>()).doc("Agents with latencies of their own.");
  describeLatencies(d, &A::senseLatency_, &A::actLatency_);
  d.property("agentStep", &A::agentStep_)
      .unit("s")
      .min(0)
      .doc("Simulated time between two turns of the agents, in which they act and sense; at most one turn per cycle.");
}

int AgentTiming::cyclesToNextTurn(double step) const {
  // As in SimSpark, a turn that is due in less than 5 ms is taken now.
  constexpr double kTolerance = 0.005;  // s
  const double cycles = step > 0 ? std::ceil((agentStep_ - kTolerance) / step - 1e-9) : 1;
  return static_cast<int>(std::clamp(cycles, 1.0, 1e6));
}

AgentLatencies AgentTiming::latencies(const AgentAspect& agent) const {
  for (const auto& own : own_)
    if (own->agent() == agent.number()) return own->latencies();
  return {senseLatency_, actLatency_};
}

}  // namespace spark
