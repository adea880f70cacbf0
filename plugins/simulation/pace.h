#pragma once
/// \file
/// Histograms of how well the run loop keeps real time. Wall time, never part of the state.

#include <string>

#include "histogram.h"
#include "spark/value.h"

namespace spark::simulation {

/// Measures each cycle. Used in the simulation's thread.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// A cycle begins at `now` that was due at `due`. `paced` false: lateness is not counted.
  void begin(Clock::time_point due, Clock::time_point now, bool paced);
  /// The cycle ends at `now`.
  void end(Clock::time_point now);
  /// Empties the histograms.
  void reset();

  /// `{{"late", cycles, p50, p90, p99, p99.9, longest}, {"long", ...}, {"done", ...}}` [us].
  List percentiles() const;
  /// `{{from, late, long, done}, ...}`: the lower end [us] and the numbers of cycles of each bucket that is not empty.
  List buckets() const;
  /// Both as a formatted table, with two rows of buckets per power of two.
  std::string table() const;

 private:
  Histogram late_;  ///< from the due time of a cycle to its beginning
  Histogram long_;  ///< from the beginning of a cycle to its end
  Histogram done_;  ///< from the due time of a cycle to its end: below a step while real time is kept
  Clock::time_point due_{}, begun_{};  ///< of the current cycle
  bool paced_ = false;
};

}  // namespace spark::simulation
