#pragma once
/// \file
/// How the host is doing, as viewers are told once a second.

#include <chrono>
#include <string>
#include <vector>

#include "api/agents.h"
#include "api/match.h"
#include "api/status.h"
#include "spark/json_writer.h"

namespace spark::web {

/// Used in the simulation's thread, between cycles. It knows no game: what a game reports of itself (IStatus) is in it,
/// and who the agents are in the game (IAgentIdentity).
class StatusReport {
 public:
  explicit StatusReport(Kernel& kernel) : kernel_(kernel) {}
  /// `{"type":"status",...}`; README.md has what is in it.
  std::string make(int spectators);

 private:
  struct Agent {
    const AgentAspect* aspect;
    std::string path;
    const IAgentIdentity* identity;  ///< nullptr: it has none
  };
  void lookUpAgents();
  void writeGame(JsonWriter& json);
  void writeAgents(JsonWriter& json) const;

  Kernel& kernel_;
  StatusReporters reporters_;
  std::vector<Agent> agents_;
  TreeWatch tree_;
  std::chrono::steady_clock::time_point madeAt_ = std::chrono::steady_clock::now();
  double time_ = 0;  ///< s, simulated, when one was made last
};

}  // namespace spark::web
