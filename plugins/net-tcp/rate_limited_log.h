#pragma once
/// \file
/// Keeps misbehaving clients from flooding the log.

#include <chrono>
#include <string_view>

#include "spark/log.h"

namespace spark::net {

/// Writes at most `kMaxLines` lines per `kPeriod` of wall time; the first line of the next period says how many were
/// dropped. Not thread-safe.
class RateLimitedLog {
 public:
  static constexpr int kMaxLines = 20;
  static constexpr std::chrono::seconds kPeriod{10};

  /// Writes or drops a line.
  void write(Log& log, Level level, std::string_view line) {
    const auto now = std::chrono::steady_clock::now();
    if (now - periodStart_ > kPeriod) {
      if (dropped_ > 0) log.warning("{} further lines about connections were dropped.", dropped_);
      periodStart_ = now;
      written_ = dropped_ = 0;
    }
    if (written_ < kMaxLines)
      ++written_, log.write(level, line);
    else
      ++dropped_;
  }

 private:
  std::chrono::steady_clock::time_point periodStart_{};
  int written_ = 0, dropped_ = 0;  ///< lines of this period
};

}  // namespace spark::net
