#pragma once
/// \file
/// One world of a batch: a kernel of its own, run in the caller's thread from the config to the row.

#include <atomic>

#include "options.h"
#include "row.h"

namespace sparkbatch {

/// What other threads may know of a running world, and do to it.
class Watch {
 public:
  /// Ends the world after the cycle that it is in; it gets no row.
  void abandon() { abandoned_ = true; }
  bool abandoned() const { return abandoned_; }
  /// Simulated seconds so far.
  double time() const { return time_; }
  void setTime(double time) { time_ = time; }

 private:
  std::atomic<bool> abandoned_ = false;
  std::atomic<double> time_ = 0;
};

/// Builds the world of `run` and throws it away. Throws spark::Error: what is wrong with the config or the settings.
void check(const Options& options, const Run& run);

/// Simulates `run` to its end and returns its row; whatever goes wrong is told in the row. The result depends on
/// nothing but the options and the run (and the times cpuSeconds and wallSeconds).
Row simulate(const Options& options, const Run& run, Watch& watch);

}  // namespace sparkbatch
