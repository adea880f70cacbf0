#pragma once
/// \file
/// How long each phase takes, for the bench and for people. Wall time: never part of the state.

#include <array>
#include <chrono>
#include <cstdint>

#include "spark/value.h"

namespace spark::simulation {

/// The parts of a cycle that are timed, in order.
enum class Part : std::size_t { input, act, prepare, physics, place, rule, sense, publish };
inline constexpr std::array<const char*, 8> kPartNames{"input", "act",  "prepare", "physics",
                                                       "place", "rule", "sense",   "publish"};

/// Sums of wall time per part. Used by the simulation's thread.
class Timers {
 public:
  using Clock = std::chrono::steady_clock;

  /// Forgets all sums.
  void reset();
  void add(Part part, Clock::duration spent) { sums_[static_cast<std::size_t>(part)] += spent; }
  /// Ends one cycle: means are per cycle.
  void cycleDone() { ++cycles_; }
  /// `{{"input", 1.2}, {"act", 3.4}, ...}`: mean per cycle since the last reset [microseconds]; all 0 before the first
  /// cycle.
  List means() const;

 private:
  std::array<Clock::duration, kPartNames.size()> sums_{};
  std::int64_t cycles_ = 0;
};

}  // namespace spark::simulation
