#pragma once
/// \file
/// How a loop keeps real time: what its cycles lost, and three histograms. Wall time: never part of the state.

#include <string>

#include "histogram.h"
#include "spark/value.h"

namespace spark::simulation {

class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// A cycle begins that was due then; `paced`: in real time.
  void begin(Clock::time_point due, Clock::time_point now, bool paced);
  void end(Clock::time_point now);
  void reset();

  /// `{{"late", cycles, p50, p90, p99, p99.9, longest}, {"long", ...}, {"done", ...}}` [us].
  List percentiles() const;
  /// `{{from, late, long, done}, ...}`: cycles in each bucket that any are in, which begins at `from` [us].
  List buckets() const;
  /// Both as a table for people, with two rows of buckets for each power of two.
  std::string table() const;

 private:
  Histogram late_;  ///< from when a cycle was due to its beginning
  Histogram long_;  ///< from its beginning to its end
  Histogram done_;  ///< from when it was due to its end: at most a step, if real time is to hold
  Clock::time_point due_{}, begun_{};
  bool paced_ = false;
};

}  // namespace spark::simulation
