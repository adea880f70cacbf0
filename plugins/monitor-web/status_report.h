#pragma once
/// \file
/// The status message that viewers get once a second.

#include <chrono>
#include <string>
#include <vector>

#include "api/agents.h"
#include "api/match.h"
#include "api/status.h"
#include "spark/json_writer.h"

namespace spark::web {

/// Writes the status message: speed, time, what the game reports (IStatus), the agents with their identity in the game
/// (IAgentIdentity). Simulation thread, between cycles.
class StatusReport {
 public:
  explicit StatusReport(Kernel& kernel) : kernel_(kernel) {}
  /// `{"type":"status",...}`; README.md describes the members. The real-time factor is that since the last call.
  /// `spectators`: number of viewers.
  std::string make(int spectators);

 private:
  struct Agent {
    const AgentAspect* aspect;
    std::string path;
    const IAgentIdentity* identity;  ///< nullptr: the game gives it none
  };
  void updateAgents();
  void writeGame(JsonWriter& json);
  void writeAgents(JsonWriter& json) const;

  Kernel& kernel_;
  StatusReporters reporters_;
  std::vector<Agent> agents_;
  TreeWatch tree_;  ///< `agents_` is rebuilt when the tree changes
  std::chrono::steady_clock::time_point lastCallAt_ = std::chrono::steady_clock::now();
  double lastTime_ = 0;  ///< s, simulated, at the last call
};

}  // namespace spark::web
