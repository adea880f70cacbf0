#include "histogram.h"

#include <algorithm>
#include <cmath>

namespace spark::simulation {

std::size_t Histogram::bucket(std::uint64_t micros) {
  // The leading 5 bits of the duration select the bucket, their position the octave.
  const int octave = std::max(0, static_cast<int>(std::bit_width(micros)) - 1 - kShift);
  const std::size_t firstOfOctave = octave << kShift;
  return std::min<std::size_t>(firstOfOctave + (micros >> octave), kBuckets - 1);
}

double Histogram::begin(std::size_t i) {
  if (i < 2u << kShift) return static_cast<double>(i);
  const std::size_t octave = (i >> kShift) - 1;
  return std::ldexp(static_cast<double>(i - (octave << kShift)), static_cast<int>(octave));
}

void Histogram::add(Duration d) {
  const double micros = std::max(0.0, std::chrono::duration<double, std::micro>(d).count());
  ++counts_[bucket(static_cast<std::uint64_t>(micros))];
  ++count_;
  longest_ = std::max(longest_, micros);
}

double Histogram::percentile(double fraction) const {
  const auto wanted = static_cast<std::int64_t>(std::ceil(fraction * static_cast<double>(count_)));
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < kBuckets; ++i)
    if ((sum += counts_[i]) >= wanted && sum > 0) return std::min(begin(i + 1), longest_);
  return longest_;
}

}  // namespace spark::simulation
