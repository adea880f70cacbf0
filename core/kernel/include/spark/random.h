#pragma once
/// \file
/// Seeded random streams, one for each node and purpose, so that a new sensor does not change the noise of another one.

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "spark/abi/spark/random.h"
#include "spark/value.h"

namespace spark {

class Leaf;

/// A stream of random numbers for one node and one purpose. Its first draw seeds it by Kernel::streamSeed. Only one
/// thread may draw at a time. The generator is xoshiro256** (Blackman and Vigna, "Scrambled Linear Pseudorandom Number
/// Generators", 2018), seeded by splitmix64.
class RandomStream {
 public:
  /// A stream of `owner`, which must outlive it, and so must `purpose` (a literal).
  RandomStream(const Leaf& owner, const char* purpose) : owner_(&owner), purpose_(purpose) {}
  /// A stream without an owner.
  explicit RandomStream(std::uint64_t seed) { this->seed(seed); }
  RandomStream(const RandomStream&) = default;
  /// Copies the state of the generator, but not owner and purpose.
  RandomStream& operator=(const RandomStream& other) {
    if (this == &other) return *this;
    for (int i = 0; i < 4; ++i) s_[i] = other.s_[i];
    spare_ = other.spare_;
    seeded_ = other.seeded_;
    hasSpare_ = other.hasSpare_;
    return *this;
  }
  /// 64 random bits.
  std::uint64_t bits();
  /// A number that is uniformly distributed in [0, 1), with 53 random bits.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// A number that is uniformly distributed in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// A number that is normally distributed, with mean `mean` and standard deviation `sigma`. Marsaglia and Bray's polar
  /// method, which makes two numbers at a time; the second is kept for the next call.
  double normal(double mean = 0, double sigma = 1);
  /// An integer that is uniformly distributed in [0, n), without bias. Precondition: n > 0.
  std::uint64_t below(std::uint64_t n);
  /// Shuffles in place (Fisher and Yates), so that all orders have the same probability.
  template <class T>
  void shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }
  /// Seeds the stream instead of the kernel.
  void seed(std::uint64_t seed);

 private:
  friend struct Convert<RandomStream>;
  const Leaf* owner_ = nullptr;
  const char* purpose_ = "";
  std::uint64_t s_[4] = {0, 0, 0, 0};  ///< state of the generator
  double spare_ = 0;                   ///< the second number of normal()
  bool seeded_ = false, hasSpare_ = false;
};

/// A stream as a Value: the generator's four words, flags, and the spare number of normal().
template <>
struct Convert<RandomStream> {
  static constexpr int kScalars = -1;
  static std::string typeName() { return "random stream"; }
  static RandomStream from(Args& args);
  static Value to(const RandomStream& stream);
};

/// A stream as a Value, in state that is read with that StateReader::branch().
Value branched(const Value& stream, std::uint64_t branch);

/// A 64-bit hash of bytes, the same on every machine: FNV-1a (Fowler, Noll, Vo) followed by the finaliser of splitmix64
/// (Steele, Lea, Flood 2014).
std::uint64_t hashBytes(std::string_view bytes, std::uint64_t seed = 0);

}  // namespace spark
