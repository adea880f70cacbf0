#pragma once
/// \file
/// Wall time of each phase, for benchmarks. Never part of the state.

#include <array>
#include <chrono>
#include <cstdint>

#include "spark/value.h"

namespace spark::simulation {

/// The parts of a cycle that are timed, in order.
enum class Part : std::size_t { input, act, prepare, physics, place, rule, sense, publish };
inline constexpr std::array<const char*, 8> kPartNames{"input", "act",  "prepare", "physics",
                                                       "place", "rule", "sense",   "publish"};

/// Sums of wall time per part. Used in the simulation's thread.
class Timers {
 public:
  using Clock = std::chrono::steady_clock;

  /// Sets all sums to 0.
  void reset();
  /// Adds to the sum of a part.
  void add(Part part, Clock::duration spent) { sums_[static_cast<std::size_t>(part)] += spent; }
  /// Counts a cycle, for the means.
  void cycleDone() { ++cycles_; }
  /// `{{"input", 1.2}, {"act", 3.4}, ...}`: mean per cycle since the last reset [us]; all 0 before the first cycle.
  List means() const;

 private:
  std::array<Clock::duration, kPartNames.size()> sums_{};
  std::int64_t cycles_ = 0;
};

}  // namespace spark::simulation
