#pragma once
/// \file
/// One run of a batch: a world with a kernel of its own, in the calling thread.

#include <atomic>

#include "options.h"
#include "row.h"

namespace sparkbatch {

/// Controls a run from another thread. All functions are thread-safe.
class RunControl {
 public:
  /// Ends the run after its current cycle; it gets no row.
  void abandon() { abandoned_ = true; }
  bool abandoned() const { return abandoned_; }
  /// Simulated time so far [s].
  double time() const { return time_; }
  void setTime(double time) { time_ = time; }

 private:
  std::atomic<bool> abandoned_ = false;
  std::atomic<double> time_ = 0;
};

/// Builds the world of the first run and destroys it. Throws spark::Error if the config or the settings are wrong, or
/// if two runs would write one file.
void check(const Options& options, const Sweep& sweep);

/// Simulates `run` to its end and returns its row. Does not throw: errors are in the row. Except for cpuSeconds and
/// wallSeconds, the row depends on the options and the run only.
Row simulate(const Options& options, const Run& run, RunControl& control);

}  // namespace sparkbatch
