#pragma once
/// \file
/// Limits the log lines about one agent.

#include <cstdint>
#include <utility>

namespace spark::gamecontrol {

/// Allows `lines` per `kWindow` cycles and counts the others. It counts cycles, not time, so that the lines of a match
/// are reproducible.
class LineBudget {
 public:
  static constexpr std::int64_t kWindow = 100;
  explicit LineBudget(int lines) : lines_(lines) {}

  /// True if a line may be written in `cycle`; otherwise counts it as dropped.
  bool take(std::int64_t cycle) {
    if (cycle - windowStart_ >= kWindow || cycle < windowStart_) windowStart_ = cycle, used_ = 0;
    if (used_ < lines_) return ++used_, true;
    ++dropped_;
    return false;
  }
  /// Number of dropped lines since the last call.
  std::int64_t takeDropped() { return std::exchange(dropped_, 0); }

 private:
  int lines_, used_ = 0;
  std::int64_t windowStart_ = 0, dropped_ = 0;
};

}  // namespace spark::gamecontrol
