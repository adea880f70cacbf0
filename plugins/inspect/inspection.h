#pragma once
/// \file
/// What clients may ask to look into the match: what touches, how joints stand, what an agent senses.
///
///     {"do":"contacts"}                {"contacts":[{"position","normal","depth","solved","force","a","b"}, ...]}
///     {"do":"joints","path":p}         {"joints":[{"path","type","anchor","axes","angles","rates",
///                                                 "torque","low","high"}, ...]}
///     {"do":"percepts","path":p}       {"time","percepts","head",
///                                       "cones":[{"path","matrix","horizontal","vertical","range"}, ...],
///                                       "seenTime","seen":[{"name","seen","true"}, ...],"lines":[[from, to], ...]}
///
/// Metres, newtons, degrees (sliders: metres), the world's frame; normals and forces are those on `a`. Matrices are
/// column by column; those of eyes look along x, z is up. `p` is a node, of an agent: any of its own. What is not known
/// is left out: forces that nobody measures, joints without stops, sight without limit, the truth about what has no
/// place.
///
/// An agent sees in some cycles only, and what it saw is to be compared with what was true then. So an agent whose
/// percepts were asked for lately is watched:
///
///     poll ─► look(): in a cycle in which a watched agent saw ─► keeps its percept with camera and true places
///     request ─► what it senses now, and what was kept

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "api/agents.h"

namespace spark::inspect {

/// Answers such requests. Used in the simulation's thread, between two cycles; changes nothing in the match.
class Inspection {
 public:
  using Json = nlohmann::json;
  explicit Inspection(Kernel& kernel) : kernel_(kernel) {}

  /// What "do" says in the requests that it answers.
  static constexpr std::array<std::string_view, 3> kRequests{"contacts", "joints", "percepts"};
  /// `{"ok":true,...}` or `{"ok":false,"error":"..."}`. Nothing is thrown.
  std::string answer(const Json& request);
  /// To be called between every two cycles, before requests are answered. Takes a fiftieth of wall time at most.
  void look();

 private:
  using Clock = std::chrono::steady_clock;
  /// An agent that somebody looks at.
  struct Watched {
    Ref<AgentAspect> agent;
    Clock::time_point askedAt, keptAt;  ///< the last time
    Json kept;                          ///< what it saw, as in the answer; null: nothing yet
    Json see;                           ///< the percept that this is made of
  };
  Json contacts() const;
  Json joints(const Json& request) const;
  Json percepts(const Json& request);
  Watched& watched(AgentAspect& agent);
  void keepWhatItSees(Watched& watched, Clock::time_point now) const;
  double time() const;

  Kernel& kernel_;
  std::vector<Watched> watched_;
  std::int64_t lookedAt_ = -1;   ///< cycle
  Clock::time_point lookDue_{};  ///< not before: looking takes its share of wall time only
};

}  // namespace spark::inspect
