#pragma once
/// \file
/// How the batch goes, on stderr: a bar that a terminal keeps up to date, elsewhere a line now and then.

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace sparkbatch {

/// One line on stderr, above the bar if there is one. Thread safe.
void sayLine(std::string_view line);

/// The bar. Speed and time left are reckoned from what this process has seen, not from rows that were there before.
class Progress {
 public:
  /// `runs`: how many the batch has; `there`: how many of them were done before; `duration`: simulated seconds of a
  /// run, 0: unknown.
  Progress(std::int64_t runs, std::int64_t there, double duration);
  /// A run has ended.
  void add(double simulatedSeconds, bool failed);
  /// Shows it when it is time. `running`: simulated seconds of the worlds that are not yet at their end.
  void show(double running);
  /// Shows the last state, whatever the time.
  void end();

  std::int64_t done() const { return done_; }
  std::int64_t failed() const { return failed_; }
  double simulated() const { return simulated_; }
  /// Wall seconds since it was made.
  double elapsed() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::string text(double running) const;

  std::int64_t runs_, there_, done_ = 0, failed_ = 0;
  double duration_, simulated_ = 0;
  bool terminal_;
  Clock::time_point begin_ = Clock::now(), next_;
};

}  // namespace sparkbatch
