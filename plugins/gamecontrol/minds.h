#pragma once
/// \file
/// The minds that drive agents inside the host: which of them join, and what each drives.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/agents.h"
#include "gamecontrol/idle_reports.h"
#include "gamecontrol/vacancies.h"

namespace spark::gamecontrol {

/// Minds (Behavior) below /usr/agent get an aspect of their own; others drive the object or the rule that they are
/// below. Simulation thread.
class Minds {
 public:
  /// Makes an agent of a mind; `aspect`: what it drives, nullptr: it gets a new one. False if that fails.
  using Join = std::function<bool(Behavior& mind, AgentAspect* aspect)>;
  /// `participants` must outlive it.
  explicit Minds(const Participants& participants) : participants_(participants) {}
  /// Calls `join` for minds that have come since the last call; what drives nothing is named in the log, once. Does
  /// nothing while the tree is unchanged. `control`: game control.
  void join(Node& control, const Join& join);
  /// The mind does not join again.
  void exclude(const Behavior& mind) { excluded_.push_back(mind.id()); }

  /// The paths of the minds that do not join, one in a line, for saved state.
  std::string excluded(const Node& root) const;
  /// These minds do not join, and no others.
  void setExcluded(std::string_view paths, const Node& root);

 private:
  AgentAspect* aspectFor(Behavior& mind) const;
  bool isKnown(const Behavior& mind) const;
  bool isExcluded(const Behavior& mind) const;

  const Participants& participants_;
  std::vector<std::uint64_t> excluded_;  ///< ids of minds whose agents could not be made or were excluded
  IdleReports idle_;
  TreeWatch tree_;
};

}  // namespace spark::gamecontrol
