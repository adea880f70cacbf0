#pragma once
/// \file
/// How the host is doing, as viewers are told once a second.

#include <chrono>
#include <string>
#include <vector>

#include "api/agents.h"

namespace spark::web {

/// Used in the simulation's thread, between cycles. Looks only at what nodes say about themselves: a house need not
/// play soccer.
class StatusReport {
 public:
  explicit StatusReport(Kernel& kernel) : kernel_(kernel) {}
  /// `{"type":"status",...}`; README.md has what is in it.
  std::string make(int spectators);

 private:
  struct Agent {
    const AgentAspect* aspect;
    std::string path;
    const Leaf* state;  ///< which says its team and number; nullptr: nothing does
  };
  void lookUpAgents();
  void putMatch(std::string& out) const;
  void putAgents(std::string& out) const;

  Kernel& kernel_;
  std::vector<Agent> agents_;
  std::uint64_t lookedUpAt_ = 0;  ///< structure version
  std::chrono::steady_clock::time_point madeAt_ = std::chrono::steady_clock::now();
  double time_ = 0;  ///< s, simulated, when one was made last
};

}  // namespace spark::web
