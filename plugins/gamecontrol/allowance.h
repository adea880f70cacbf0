#pragma once
/// \file
/// How much of something (seconds, robots, lines) clients may take: much at once, little for ever.

#include <algorithm>
#include <chrono>

namespace spark::gamecontrol {

using Clock = std::chrono::steady_clock;

/// A token bucket on the wall clock. It may go into debt: what was taken is known afterwards only.
class Allowance {
 public:
  Allowance(double most, double perSecond) : most_(most), perSecond_(perSecond), left_(most) {}
  /// Changes how much there is at once; what was taken stays taken.
  void setMost(double most) { left_ += most - std::exchange(most_, most); }
  /// True when something is left, as of the last refill.
  bool left() const { return left_ > 0; }
  void refill(Clock::time_point now) {
    if (refilledAt_ != Clock::time_point())
      left_ = std::min(most_, left_ + perSecond_ * std::chrono::duration<double>(now - refilledAt_).count());
    refilledAt_ = now;
  }
  void spend(double amount) { left_ = std::max(left_ - amount, -most_); }
  /// Refills, and takes one when there is one.
  bool take(Clock::time_point now) {
    refill(now);
    if (left_ < 1) return false;
    --left_;
    return true;
  }

 private:
  double most_, perSecond_, left_;
  Clock::time_point refilledAt_{};
};

}  // namespace spark::gamecontrol
