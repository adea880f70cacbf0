#pragma once
/// \file
/// Keeps misbehaving clients from flooding the log.

#include <chrono>
#include <string_view>

#include "spark/log.h"

namespace spark::net {

/// Writes at most `kLines` lines per `kPeriod` of wall clock; says afterwards how many were left out.
class Complaints {
 public:
  static constexpr int kLines = 20;
  static constexpr std::chrono::seconds kPeriod{10};

  void write(Log& log, Level level, std::string_view line) {
    const auto now = std::chrono::steady_clock::now();
    if (now - begin_ > kPeriod) {
      if (left_ > 0) log.warning("{} further lines about connections were left out.", left_);
      begin_ = now;
      written_ = left_ = 0;
    }
    if (written_ < kLines)
      ++written_, log.write(level, line);
    else
      ++left_;
  }

 private:
  std::chrono::steady_clock::time_point begin_{};
  int written_ = 0, left_ = 0;
};

}  // namespace spark::net
