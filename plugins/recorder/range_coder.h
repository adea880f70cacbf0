#pragma once
/// \file
/// Bits that are more or less probable, as few bytes: a binary arithmetic coder (Rissanen), with probabilities that
/// follow what was coded.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "spark/error.h"

namespace spark::recorder {

/// How probable a bit is that was coded in the same place before. The first ones count more than the later ones.
class Chance {
 public:
  /// That the next bit is set, in 2^-16: never 0, never 2^16.
  std::uint32_t ofOne() const { return estimate_ | 1u; }
  void update(bool bit) {
    const int off = (bit ? 0xffff : 0) - estimate_;
    estimate_ = static_cast<std::uint16_t>(estimate_ + 2 * off / (2 * count_ + 3));
    if (count_ < kMost) ++count_;
  }

 private:
  static constexpr int kMost = 100;
  std::uint16_t estimate_ = 0x8000, count_ = 0;
};

/// The interval of numbers that begin as what was coded so far; each bit keeps its part of it.
class Interval {
 protected:
  /// The last number of the part of a set bit.
  std::uint32_t middle(std::uint32_t ofOne) const {
    return low_ + static_cast<std::uint32_t>(std::uint64_t{high_ - low_} * ofOne >> 16);
  }
  void keep(bool bit, std::uint32_t middle) { bit ? high_ = middle : low_ = middle + 1; }
  /// Forgets a byte that is the same in the whole interval; false: there is none.
  bool shift() {
    if ((low_ ^ high_) >> 24 != 0) return false;
    low_ <<= 8;
    high_ = high_ << 8 | 0xff;
    return true;
  }
  std::uint32_t low_ = 0, high_ = 0xffffffff;
};

/// Writes bits. A coder that writes and one that reads have the same functions, so that one description of a format
/// serves both: they return what they were given, or what was read.
class RangeWriter : private Interval {
 public:
  static constexpr bool kReads = false;
  /// Appends to `out`, which must outlive the writer.
  explicit RangeWriter(std::string& out) : out_(out) {}
  bool bit(Chance& chance, bool value) {
    put(chance.ofOne(), value);
    chance.update(value);
    return value;
  }
  /// The lowest `count` bits of a number, about which nothing is known.
  std::uint64_t bits(int count, std::uint64_t value) {
    for (int i = count; i-- > 0;) put(0x8000, value >> i & 1);
    return value;
  }
  /// Writes the last bytes, as few as possible: a reader takes missing bytes as 0.
  void finish() {
    std::uint32_t last = 0, mask = 0;
    for (int n = 0; n < 4 && last < low_; ++n) {
      mask = mask >> 8 | 0xff000000;
      last = high_ & mask;
    }
    for (; last != 0; last <<= 8) out_ += static_cast<char>(last >> 24);
  }

 private:
  void put(std::uint32_t ofOne, bool value) {
    keep(value, middle(ofOne));
    for (std::uint32_t first = high_ >> 24; shift(); first = high_ >> 24) out_ += static_cast<char>(first);
  }
  std::string& out_;
};

/// Reads what a RangeWriter wrote. Throws Error if the bytes end early.
class RangeReader : private Interval {
 public:
  static constexpr bool kReads = true;
  /// `bytes` must outlive the reader.
  explicit RangeReader(std::string_view bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) next();
  }
  bool bit(Chance& chance, bool = false) {
    const bool value = take(chance.ofOne());
    chance.update(value);
    return value;
  }
  std::uint64_t bits(int count, std::uint64_t = 0) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 1 | static_cast<std::uint64_t>(take(0x8000));
    return value;
  }
  /// Throws Error unless all bytes were read.
  void finish() const {
    if (!bytes_.empty()) throw Error("inputs are damaged: there are bytes behind the last one");
  }

 private:
  bool take(std::uint32_t ofOne) {
    const std::uint32_t half = middle(ofOne);
    const bool value = code_ <= half;
    keep(value, half);
    while (shift()) next();
    return value;
  }
  void next() {
    code_ <<= 8;
    if (!bytes_.empty()) {
      code_ |= static_cast<unsigned char>(bytes_.front());
      bytes_.remove_prefix(1);
    } else if (++missing_ > 4) {
      throw Error("inputs are damaged: they end early");
    }
  }
  std::string_view bytes_;
  std::uint32_t code_ = 0;
  int missing_ = 0;
};

/// A number below 2^Bits, bit by bit from the highest; each has a chance for each value of those above it.
template <int Bits>
class Symbol {
 public:
  template <class Coder>
  unsigned code(Coder& coder, unsigned value = 0) {
    unsigned node = 1;
    for (int i = Bits; i-- > 0;) node = node << 1 | static_cast<unsigned>(coder.bit(chances_[node], value >> i & 1));
    return node - (1u << Bits);
  }

 private:
  Chance chances_[1 << Bits];
};

/// A number that is the more probable the nearer to zero it is: how many bits it has, its sign, its first bits, and the
/// rest as it is. `Lengths`, `Signs`: of how many kinds, which differ in how many bits they have, and in their sign.
template <unsigned Lengths = 1, unsigned Signs = 1>
class Number {
 public:
  template <class Coder>
  std::int64_t code(Coder& coder, std::int64_t value = 0, unsigned lengthKind = 0, unsigned signKind = 0) {
    const bool negative = value < 0;
    const std::uint64_t size = negative ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
    const unsigned length = lengths_[lengthKind].code(coder, static_cast<unsigned>(std::bit_width(size)));
    if (length == 0) return 0;
    if (length > 64) throw Error("inputs are damaged: a number has too many bits");
    const bool below = coder.bit(signs_[length][signKind], negative);
    const int known = std::min(static_cast<int>(length) - 1, kKnown), rest = static_cast<int>(length) - 1 - known;
    std::uint64_t out = 1;
    for (int i = known; i-- > 0;)
      out = out << 1 | static_cast<std::uint64_t>(coder.bit(firsts_[length][out], size >> (rest + i) & 1));
    out = out << rest | coder.bits(rest, size & ((std::uint64_t{1} << rest) - 1));
    return static_cast<std::int64_t>(below ? 0 - out : out);
  }

 private:
  static constexpr int kKnown = 2;  ///< bits behind the first one that have chances
  Symbol<7> lengths_[Lengths];
  Chance signs_[65][Signs], firsts_[65][1 << kKnown];
};

}  // namespace spark::recorder
