#include "spark/random.h"

#include <bit>
#include <cmath>

#include "spark/assert.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark {

namespace {
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}
std::uint64_t rotl(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }
}  // namespace

std::uint64_t hashBytes(std::string_view bytes, std::uint64_t seed) {
  std::uint64_t h = 14695981039346656037ull ^ mix(seed + 0x9e3779b97f4a7c15ull);
  for (unsigned char c : bytes) h = (h ^ c) * 1099511628211ull;
  return mix(h);
}

void RandomStream::seed(std::uint64_t seed) {
  for (std::uint64_t& s : s_) s = mix(seed += 0x9e3779b97f4a7c15ull);
  seeded_ = true;
  hasSpare_ = false;
}

std::uint64_t RandomStream::bits() {
  if (!seeded_) seed(owner_->kernel().streamSeed(*owner_, purpose_));
  const std::uint64_t result = rotl(s_[1] * 5, 7) * 9, t = s_[1] << 17;
  s_[2] ^= s_[0];
  s_[3] ^= s_[1];
  s_[1] ^= s_[2];
  s_[0] ^= s_[3];
  s_[2] ^= t;
  s_[3] = rotl(s_[3], 45);
  return result;
}

double RandomStream::normal(double mean, double sigma) {
  if (hasSpare_) {
    hasSpare_ = false;
    return mean + sigma * spare_;
  }
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
  // Lemire's rejection on the high half of the product.
  std::uint64_t x = bits();
  __extension__ typedef unsigned __int128 Wide;
  Wide m = static_cast<Wide>(x) * n;
  if (static_cast<std::uint64_t>(m) < n) {
    const std::uint64_t threshold = (0 - n) % n;
    while (static_cast<std::uint64_t>(m) < threshold) m = static_cast<Wide>(bits()) * n;
  }
  return static_cast<std::uint64_t>(m >> 64);
}

RandomStream Convert<RandomStream>::from(Args& args) {
  const Value& v = args.take();
  if (!v.isList() || v.toList().size() != 6)
    throw Error("expected the six numbers of a random stream, found " + v.text());
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

}  // namespace spark
