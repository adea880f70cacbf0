#pragma once
/// \file
/// Requests about contacts, joints and what an agent senses.
///
///     {"do":"contacts"}                {"contacts":[{"position","normal","depth","solved","force","a","b"}, ...]}
///     {"do":"joints","path":p}         {"joints":[{"path","type","anchor","axes","angles","rates",
///                                                 "torque","low","high"}, ...]}
///     {"do":"percepts","path":p}       {"time","percepts","head",
///                                       "cones":[{"path","matrix","horizontal","vertical","range"}, ...],
///                                       "seenTime","seen":[{"name","seen","true"}, ...],"lines":[[from, to], ...]}
///
/// Metres, newtons, degrees (sliders: metres), world frame; normals and forces act on `a`. Matrices are column by
/// column; eyes look along x, z is up. `p` is a node; for agents any node of the agent. Unknown values are omitted:
/// forces that are not measured, limits of joints without stops, unlimited range, true positions of objects without
/// one.
///
/// An agent sees in some cycles only, and its percept is to be compared with the true positions of that cycle. So
/// agents whose percepts were requested recently are observed:
///
///     poll ─► observe(): in a cycle in which an observed agent saw ─► stores its percept with the true positions
///     request ─► what the agent senses now, and what was stored

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "api/agents.h"

namespace spark::inspect {

/// Answers these requests. Simulation thread, between two cycles. Changes nothing in the match.
class Inspection {
 public:
  using Json = nlohmann::json;
  /// `kernel` must outlive it.
  explicit Inspection(Kernel& kernel) : kernel_(kernel) {}

  /// Values of "do" in these requests.
  static constexpr std::array<std::string_view, 3> kRequests{"contacts", "joints", "percepts"};
  /// The answer: `{"ok":true,...}` or `{"ok":false,"error":"..."}`. Does not throw.
  std::string answer(const Json& request);
  /// Stores what observed agents see. Call it between every two cycles, before requests are answered. Takes at most a
  /// fiftieth of wall time.
  void observe();

 private:
  using Clock = std::chrono::steady_clock;
  /// An agent whose percepts were requested recently.
  struct Observed {
    Ref<AgentAspect> agent;
    Clock::time_point requestedAt;  ///< when its percepts were requested last
    Clock::time_point storedAt;     ///< when `sight` was stored
    Json sight;                     ///< what it saw, as in the answer; null: nothing yet
    Json see;                       ///< the percept from which `sight` was made
  };
  Json contacts() const;
  Json joints(const Json& request) const;
  Json percepts(const Json& request);
  Observed& observed(AgentAspect& agent);
  void storeSight(Observed& observed, Clock::time_point now) const;
  double time() const;

  Kernel& kernel_;
  std::vector<Observed> observed_;
  std::int64_t lastCycle_ = -1;     ///< of the last observe()
  Clock::time_point observeDue_{};  ///< observe() does nothing before, which limits its share of wall time
};

}  // namespace spark::inspect
