#pragma once
/// \file
/// Seeded random streams, one per node and purpose: adding a sensor does not change another sensor's noise.

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "spark/abi/spark/random.h"
#include "spark/value.h"

namespace spark {

class Leaf;

/// A stream of random numbers that belongs to one node and one purpose. Keyed at its first draw by the kernel's seed,
/// the node's path and class, the purpose, and an ordinal among equals. Draws are made by one thread at a time.
/// Generator: xoshiro256** (Blackman, Vigna 2018).
class RandomStream {
 public:
  /// `purpose` must outlive the stream (a literal).
  RandomStream(const Leaf& owner, const char* purpose) : owner_(&owner), purpose_(purpose) {}
  /// A free stream with a seed of its own.
  explicit RandomStream(std::uint64_t seed) { this->seed(seed); }
  RandomStream(const RandomStream&) = default;
  /// Takes over the numbers; a stream that belongs to a node goes on belonging to it.
  RandomStream& operator=(const RandomStream& other) {
    for (int i = 0; i < 4; ++i) s_[i] = other.s_[i];
    spare_ = other.spare_;
    seeded_ = other.seeded_;
    hasSpare_ = other.hasSpare_;
    return *this;
  }
  /// 64 random bits.
  std::uint64_t bits();
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Normal with the given mean and standard deviation (Marsaglia's polar method, one draw kept).
  double normal(double mean = 0, double sigma = 1);
  /// Uniform integer in [0, n), n > 0, unbiased.
  std::uint64_t below(std::uint64_t n);
  /// Shuffles in place (Fisher, Yates).
  template <class T>
  void shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }
  void seed(std::uint64_t seed);

 private:
  friend struct Convert<RandomStream>;
  const Leaf* owner_ = nullptr;
  const char* purpose_ = "";
  std::uint64_t s_[4] = {0, 0, 0, 0};
  double spare_ = 0;
  bool seeded_ = false, hasSpare_ = false;
};

/// A stream as state: six integers.
template <>
struct Convert<RandomStream> {
  static constexpr int kScalars = -1;
  static std::string typeName() { return "random stream"; }
  static RandomStream from(Args& args);
  static Value to(const RandomStream& stream);
};

/// A well-mixed 64-bit hash of bytes (FNV-1a followed by splitmix64's finaliser), the same on every machine.
std::uint64_t hashBytes(std::string_view bytes, std::uint64_t seed = 0);

}  // namespace spark
