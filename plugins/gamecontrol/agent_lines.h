#pragma once
/// \file
/// The log lines that agents cause, limited for all of them together: who connects again and again cannot fill a disk.

#include <string_view>

#include "gamecontrol/allowance.h"
#include "spark/log.h"

namespace spark::gamecontrol {

/// So many lines at once, then one a second; says how many were left out.
class AgentLines {
 public:
  static constexpr double kAtOnce = 300, kPerSecond = 1;

  explicit AgentLines(Log& log) : log_(&log) {}
  void write(Level level, std::string_view line) {
    if (!log_->enabled(level)) return;
    if (!allowance_.take(Clock::now())) return void(++leftOut_);
    if (leftOut_ > 0) log_->warning("{} further lines about agents were left out.", std::exchange(leftOut_, 0));
    log_->write(level, line);
  }

 private:
  Log* log_;
  Allowance allowance_{kAtOnce, kPerSecond};
  std::int64_t leftOut_ = 0;
};

}  // namespace spark::gamecontrol
