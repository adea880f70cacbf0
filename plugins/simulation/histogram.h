#pragma once
/// \file
/// How long something takes, cycle by cycle: counts in fixed buckets. Wall time: never part of the state.

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>

namespace spark::simulation {

/// Counts durations from 0 to two minutes, each within 1/16 of its size (below 16 us: to the microsecond). Adding
/// allocates nothing.
class Histogram {
 public:
  using Duration = std::chrono::steady_clock::duration;

  /// What is below 0 counts as 0, what is too long as the longest.
  void add(Duration d);
  void reset() { *this = {}; }
  std::int64_t count() const { return count_; }
  /// Microseconds that a share (0..1) of all stayed within: the upper end of a bucket, but no more than the longest; 0
  /// without any.
  double percentile(double share) const;
  double longest() const { return longest_; }

  static constexpr std::size_t kBuckets = 16 * 24;
  std::int64_t inBucket(std::size_t i) const { return counts_[i]; }
  /// Microseconds at which a bucket begins.
  static double begin(std::size_t i);

 private:
  static constexpr int kShift = 4;  // 16 buckets for each power of two
  static std::size_t bucket(std::uint64_t micros);
  std::array<std::int64_t, kBuckets> counts_{};
  std::int64_t count_ = 0;
  double longest_ = 0;  ///< us
};

}  // namespace spark::simulation
