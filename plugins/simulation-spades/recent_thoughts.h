#pragma once
/// \file
/// The last thoughts of an agent.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace spark::spades {

/// How long the last kMost thoughts took [steps].
class RecentThoughts {
 public:
  static constexpr std::size_t kMost = 32;
  void add(std::int64_t steps) { sum_ += steps - std::exchange(steps_[count_++ % kMost], steps); }
  /// The last one; NaN before the first.
  double last() const {
    return count_ == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(steps_[(count_ - 1) % kMost]);
  }
  /// Their mean; NaN before the first.
  double mean() const {
    return count_ == 0 ? std::numeric_limits<double>::quiet_NaN()
                       : static_cast<double>(sum_) / static_cast<double>(std::min(count_, kMost));
  }

 private:
  std::array<std::int64_t, kMost> steps_{};  ///< a ring
  std::size_t count_ = 0;                    ///< of all thoughts
  std::int64_t sum_ = 0;                     ///< of the ring
};

}  // namespace spark::spades
