#pragma once
/// \file
/// The log lines that agents cause, limited for all agents together: a client that connects again and again must not
/// fill a disk.

#include <string_view>

#include "gamecontrol/token_bucket.h"
#include "spark/log.h"

namespace spark::gamecontrol {

/// Writes at most `kBurst` lines at once and `kPerSecond` on average; the next line that is written says how many were
/// dropped.
class AgentLog {
 public:
  static constexpr double kBurst = 300, kPerSecond = 1;

  /// `log` must outlive it.
  explicit AgentLog(Log& log) : log_(&log) {}
  /// Writes or drops a line; false if it was dropped.
  bool write(Level level, std::string_view line) {
    if (!log_->enabled(level)) return true;
    if (!bucket_.take(Clock::now())) return ++dropped_, false;
    if (dropped_ > 0) log_->warning("{} further lines about agents were dropped.", std::exchange(dropped_, 0));
    log_->write(level, line);
    return true;
  }

 private:
  Log* log_;
  TokenBucket bucket_{kBurst, kPerSecond};
  std::int64_t dropped_ = 0;
};

}  // namespace spark::gamecontrol
