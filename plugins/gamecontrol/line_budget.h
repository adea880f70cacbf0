#pragma once
/// \file
/// How many log lines somebody may cause.

#include <cstdint>

namespace spark::gamecontrol {

/// At most `lines` per `kWindow` cycles; counts what was left out. Counted in cycles: no clock, and a halted host does
/// not chatter.
class LineBudget {
 public:
  static constexpr std::int64_t kWindow = 100;
  explicit LineBudget(int lines) : lines_(lines) {}

  /// True when one more line may be written in `cycle`.
  bool take(std::int64_t cycle) {
    if (cycle - begin_ >= kWindow || cycle < begin_) begin_ = cycle, used_ = 0;
    if (used_ < lines_) return ++used_, true;
    ++leftOut_;
    return false;
  }
  /// Lines left out since the last call.
  std::int64_t leftOut() {
    const std::int64_t n = leftOut_;
    leftOut_ = 0;
    return n;
  }

 private:
  int lines_, used_ = 0;
  std::int64_t begin_ = 0, leftOut_ = 0;
};

}  // namespace spark::gamecontrol
