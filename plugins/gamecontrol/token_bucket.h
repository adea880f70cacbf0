#pragma once
/// \file
/// A token bucket: limits how much of something (seconds, robots, log lines) clients may use.

#include <algorithm>
#include <chrono>
#include <utility>

namespace spark::gamecontrol {

using Clock = std::chrono::steady_clock;

/// A token bucket on the wall clock. It starts full. Its level may become negative, since some costs are known only
/// after they were caused.
class TokenBucket {
 public:
  /// `capacity`: the maximum level. `perSecond`: what refill() adds per second.
  TokenBucket(double capacity, double perSecond) : capacity_(capacity), perSecond_(perSecond), level_(capacity) {}
  /// Changes the capacity, and the level by the same amount.
  void setCapacity(double capacity) { level_ += capacity - std::exchange(capacity_, capacity); }
  /// True if the level is positive, as of the last refill.
  bool available() const { return level_ > 0; }
  /// Adds what has accrued since the last refill.
  void refill(Clock::time_point now) {
    if (refilledAt_ != Clock::time_point())
      level_ = std::min(capacity_, level_ + perSecond_ * std::chrono::duration<double>(now - refilledAt_).count());
    refilledAt_ = now;
  }
  /// Removes `amount`; the level does not sink below minus the capacity.
  void spend(double amount) { level_ = std::max(level_ - amount, -capacity_); }
  /// Refills and removes one token; false if there is none.
  bool take(Clock::time_point now) {
    refill(now);
    if (level_ < 1) return false;
    --level_;
    return true;
  }

 private:
  double capacity_, perSecond_, level_;
  Clock::time_point refilledAt_{};
};

}  // namespace spark::gamecontrol
