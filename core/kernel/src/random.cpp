#include "spark/random.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "spark/assert.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark {

namespace {
__extension__ using Wide = unsigned __int128;

constexpr std::uint64_t kGoldenGamma =
    0x9e3779b97f4a7c15ull;  // increment of splitmix64: 2^64 divided by the golden ratio

/// The finaliser of splitmix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}
}  // namespace

std::uint64_t hashBytes(std::string_view bytes, std::uint64_t seed) {
  constexpr std::uint64_t kFnvOffset = 14695981039346656037ull, kFnvPrime = 1099511628211ull;
  std::uint64_t h = kFnvOffset ^ mix(seed + kGoldenGamma);
  for (unsigned char c : bytes) h = (h ^ c) * kFnvPrime;
  return mix(h);
}

void RandomStream::seed(std::uint64_t seed) {
  for (std::uint64_t& s : s_) s = mix(seed += kGoldenGamma);
  seeded_ = true;
  hasSpare_ = false;
}

std::uint64_t RandomStream::bits() {
  if (!seeded_) seed(owner_->kernel().streamSeed(*owner_, purpose_));
  // xoshiro256**.
  const std::uint64_t result = std::rotl(s_[1] * 5, 7) * 9, t = s_[1] << 17;
  s_[2] ^= s_[0];
  s_[3] ^= s_[1];
  s_[1] ^= s_[2];
  s_[0] ^= s_[3];
  s_[2] ^= t;
  s_[3] = std::rotl(s_[3], 45);
  return result;
}

double RandomStream::normal(double mean, double sigma) {
  if (hasSpare_) {
    hasSpare_ = false;
    return mean + sigma * spare_;
  }
  // A point in the unit circle gives two independent normal numbers.
  double u, v, s;
  do {
    u = uniform(-1, 1);
    v = uniform(-1, 1);
    s = u * u + v * v;
  } while (s >= 1 || s == 0);
  const double f = std::sqrt(-2 * std::log(s) / s);
  spare_ = v * f;
  hasSpare_ = true;
  return mean + sigma * u * f;
}

std::uint64_t RandomStream::below(std::uint64_t n) {
  SPARK_ASSERT(n > 0);
  // Lemire, "Fast Random Integer Generation in an Interval", 2019: the high half of a 128-bit product is in [0, n). It
  // is without bias if products whose low half is below 2^64 mod n are rejected.
  Wide m = static_cast<Wide>(bits()) * n;
  if (static_cast<std::uint64_t>(m) < n) {
    const std::uint64_t threshold = (0 - n) % n;
    while (static_cast<std::uint64_t>(m) < threshold) m = static_cast<Wide>(bits()) * n;
  }
  return static_cast<std::uint64_t>(m >> 64);
}

RandomStream Convert<RandomStream>::from(Args& args) {
  const Value& v = args.take();
  if (!v.isList() || v.toList().size() != 6)
    throw Error(fmt::format("expected the six numbers of a random stream, found {}", v.text()));
  RandomStream out(0);
  const List& l = v.toList();
  for (int i = 0; i < 4; ++i) out.s_[i] = static_cast<std::uint64_t>(l[i].toInteger());
  const std::int64_t flags = l[4].toInteger();
  out.seeded_ = flags & 1;
  out.hasSpare_ = flags & 2;
  out.spare_ = l[5].toNumber();
  return out;
}

Value Convert<RandomStream>::to(const RandomStream& r) {
  List out;
  for (const std::uint64_t s : r.s_) out.push_back(s);
  out.push_back(static_cast<std::int64_t>((r.seeded_ ? 1 : 0) | (r.hasSpare_ ? 2 : 0)));
  out.push_back(r.hasSpare_ ? r.spare_ : 0.0);
  return out;
}

Value branched(const Value& stream, std::uint64_t branch) {
  if (branch == 0 || !stream.isList() || stream.toList().size() != 6) return stream;
  List out = stream.toList();
  // New words from the old ones, so that no draw of a branch is one of another.
  std::uint64_t seed = branch;
  for (int i = 0; i < 4; ++i) seed = mix(seed ^ static_cast<std::uint64_t>(out[i].toInteger()));
  for (int i = 0; i < 4; ++i) out[i] = Value(static_cast<std::int64_t>(mix(seed += kGoldenGamma)));
  out[4] = out[4].toInteger() & 1;  // without a second number of normal()
  out[5] = 0.0;
  return out;
}

}  // namespace spark
