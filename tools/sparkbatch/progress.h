#pragma once
/// \file
/// The progress of a batch on stderr: on a terminal a bar that is updated, otherwise a line from time to time.

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace sparkbatch {

/// Prints a line to stderr, above the bar if there is one. Thread-safe.
void printLine(std::string_view line);

/// The progress bar. Speed and remaining time are estimated from the runs since the program was started.
class Progress {
 public:
  /// `runs`: number of runs of the batch; `existing`: number of them that had a row before; `duration`: simulated
  /// seconds of a run, 0: unknown.
  Progress(std::int64_t runs, std::int64_t existing, double duration);
  /// Counts a run that has ended.
  void add(double simulatedSeconds, bool failed);
  /// Updates the display if it is due. `running`: simulated seconds of the current runs, in sum.
  void show(double running);
  /// Shows the final state.
  void end();

  /// Number of runs that have ended, and of those with an error.
  std::int64_t done() const { return done_; }
  std::int64_t failed() const { return failed_; }
  /// Simulated seconds of all ended runs.
  double simulated() const { return simulated_; }
  /// Wall time since construction [s].
  double elapsed() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::string text(double running) const;

  std::int64_t runs_, existing_, done_ = 0, failed_ = 0;
  double duration_, simulated_ = 0;
  bool terminal_;
  Clock::time_point begin_ = Clock::now(), next_;  ///< next_: of the next update
};

}  // namespace sparkbatch
