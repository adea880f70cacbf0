#pragma once
/// \file
/// Histogram of durations with fixed buckets. Wall time, never part of the state.

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>

namespace spark::simulation {

/// Counts durations from 0 to two minutes with a relative resolution of 1/16; below 16 us of 1 us. Does not allocate.
class Histogram {
 public:
  using Duration = std::chrono::steady_clock::duration;

  /// Counts a duration. Negative durations count as 0; those beyond the last bucket are counted in the last bucket.
  void add(Duration d);
  /// Removes all counts.
  void reset() { *this = {}; }
  /// Number of durations.
  std::int64_t count() const { return count_; }
  /// The duration [us] that the fraction `fraction` (0..1) of all durations does not exceed: the upper end of a bucket,
  /// at most longest(); 0 without durations.
  double percentile(double fraction) const;
  /// The longest duration [us]; 0 without durations.
  double longest() const { return longest_; }

  static constexpr std::size_t kBuckets = 16 * 24;
  /// Number of durations in bucket `i`, below kBuckets.
  std::int64_t inBucket(std::size_t i) const { return counts_[i]; }
  /// Lower end of bucket `i` [us].
  static double begin(std::size_t i);

 private:
  static constexpr int kShift = 4;  // 2^4 = 16 buckets per power of two
  /// The bucket of a duration.
  static std::size_t bucket(std::uint64_t micros);
  std::array<std::int64_t, kBuckets> counts_{};
  std::int64_t count_ = 0;
  double longest_ = 0;  ///< us
};

}  // namespace spark::simulation
