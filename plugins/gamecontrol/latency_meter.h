#pragma once
/// \file
/// Measures how long an agent takes to answer percepts.

#include <chrono>
#include <cmath>
#include <limits>

#include "gamecontrol/token_bucket.h"

namespace spark::gamecontrol {

/// Wall time from the first percepts that are not answered yet to the next message, exponentially smoothed.
class LatencyMeter {
 public:
  /// Percepts were sent.
  void onPercepts(Clock::time_point now) {
    if (sentAt_ == Clock::time_point()) sentAt_ = now;
  }
  /// A message came.
  void onMessage(Clock::time_point now) {
    if (sentAt_ == Clock::time_point()) return;
    const double elapsed = std::chrono::duration<double>(now - sentAt_).count();
    seconds_ = std::isnan(seconds_) ? elapsed : seconds_ + (elapsed - seconds_) / kSmoothing;
    sentAt_ = {};
  }
  /// The latency in seconds; NaN if there was no answer yet.
  double seconds() const { return seconds_; }

 private:
  static constexpr double kSmoothing = 16;  // answers
  Clock::time_point sentAt_{};              // zero: no percepts are unanswered
  double seconds_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace spark::gamecontrol
