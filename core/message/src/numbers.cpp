#include "spark/numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

// The digits of a number up to its k-th decimal are the whole number next to v * 10^k. In double precision that product
// is off by less than 1e-6, which matters only next to a tie. There it is worked out exactly: a double is m * 2^e with
// a whole m below 2^53, and m * 5^k fits 128 bits for k up to 27, so that dividing by the power of two that is left
// loses nothing, and ties go to the even digit as C wants it. Numbers that are larger or smaller than those of messages
// go the long way through std::to_chars.

namespace spark {

namespace {

__extension__ using Wide = unsigned __int128;

static_assert(std::endian::native == std::endian::little,
              "digits are put together in a word, the first in its lowest byte");

constexpr int kGeneralDigits = 6;                 // of %g
constexpr std::uint64_t kZeros = 0x303030303030;  // so many
constexpr int kMostDecimals = 27;                 // 5^27 < 2^63
constexpr auto kFives = [] {
  std::array<std::uint64_t, kMostDecimals + 1> out{1};
  for (std::size_t k = 1; k < out.size(); ++k) out[k] = out[k - 1] * 5;
  return out;
}();
constexpr auto kTens = [] {
  std::array<std::uint64_t, 20> out{1};
  for (std::size_t k = 1; k < out.size(); ++k) out[k] = out[k - 1] * 10;
  return out;
}();
constexpr std::array kPowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                             1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22, 1e23, 1e24, 1e25, 1e26, 1e27};
/// "00" to "99".
constexpr auto kPairs = [] {
  std::array<char, 200> out{};
  for (std::size_t i = 0; i < 100; ++i)
    out[2 * i] = static_cast<char>('0' + i / 10), out[2 * i + 1] = static_cast<char>('0' + i % 10);
  return out;
}();

/// |v| * 10^k, rounded to the nearest whole number, ties to the even one. |v| < 2^31, 0 <= k <= kMostDecimals, the
/// result below 2^63.
[[gnu::noinline]] std::uint64_t scaledExactly(double v, int k) {
  constexpr int kMantissaBits = 52, kBias = 1075;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(v) & ~(1ull << 63);
  const auto exponent = static_cast<int>(bits >> kMantissaBits);
  const std::uint64_t fraction = bits & ((1ull << kMantissaBits) - 1);
  const std::uint64_t mantissa = exponent > 0 ? fraction | 1ull << kMantissaBits : fraction;
  const int shift = kBias - std::max(exponent, 1) - k;
  if (shift >= 120) return 0;  // less than half: the product has 116 bits at most
  const Wide product = static_cast<Wide>(mantissa) * kFives[static_cast<std::size_t>(k)];
  const auto whole = static_cast<std::uint64_t>(product >> shift);
  const Wide rest = product & ((static_cast<Wide>(1) << shift) - 1), half = static_cast<Wide>(1) << (shift - 1);
  return whole + (rest > half || (rest == half && whole % 2));
}

/// The whole number next to `product`, which is below 2^30 and was rounded twice; false when it is too near a tie for
/// that.
inline bool nearest(double product, std::uint64_t& whole) {
  constexpr double kMargin = 1e-6;
  constexpr double kUnits = 0x1p52;  // from here on doubles are whole numbers, which stand in their lower bits
  const double rounded = product + kUnits;
  whole = std::bit_cast<std::uint64_t>(rounded) ^ std::bit_cast<std::uint64_t>(kUnits);
  return std::abs(product - (rounded - kUnits)) < 0.5 - kMargin;
}

/// As scaledExactly(), in double precision where that cannot go wrong.
inline std::uint64_t scaled(double v, int k) {
  const double product = std::abs(v) * kPowers[static_cast<std::size_t>(k)];
  std::uint64_t whole = 0;
  return product < 0x1p30 && nearest(product, whole) ? whole : scaledExactly(v, k);
}

/// How many digits it has; none for 0.
int countDigits(std::uint64_t v) {
  const int guess = (64 - std::countl_zero(v | 1)) * 1233 >> 12;  // log10(2) = 1233 / 4096
  return guess + (v >= kTens[static_cast<std::size_t>(guess)]);
}

/// Writes the last `count` digits of `v` so that they end before `end`, and takes them off `v`.
void putDigits(char* end, std::uint64_t& v, int count) {
  for (; count >= 2; count -= 2, v /= 100) std::memcpy(end -= 2, &kPairs[2 * (v % 100)], 2);
  if (count > 0) *--end = static_cast<char>('0' + v % 10), v /= 10;
}

/// Two digits, as they stand in memory.
std::uint64_t pair(std::uint32_t v) {
  std::uint16_t out;
  std::memcpy(&out, &kPairs[2 * v], sizeof out);
  return out;
}

template <class... Format>
char* putSlowly(char* to, std::size_t room, double v, Format... format) {
  return std::to_chars(to, to + room, v, format...).ptr;
}

/// How %g writes numbers of one decimal exponent: what comes before the digits, how many of them before the point, how
/// many at least, what comes behind them.
struct Layout {
  char before[8] = {}, behind[4] = {};
  std::uint8_t beforeSize = 0, whole = kGeneralDigits, least = 0, behindSize = 0;
};
constexpr int kLeastExponent = -22, kMostExponent = 6;
constexpr auto kLayouts = [] {
  std::array<Layout, kMostExponent - kLeastExponent + 1> out{};
  for (int exponent = kLeastExponent; exponent <= kMostExponent; ++exponent) {
    Layout& layout = out[static_cast<std::size_t>(exponent - kLeastExponent)];
    if (exponent < -4 || exponent >= kGeneralDigits) {
      const auto size = static_cast<std::size_t>(exponent < 0 ? -exponent : exponent);
      layout.whole = layout.least = 1;
      layout.behind[layout.behindSize++] = 'e';
      layout.behind[layout.behindSize++] = exponent < 0 ? '-' : '+';
      for (const std::size_t i : {2 * size, 2 * size + 1}) layout.behind[layout.behindSize++] = kPairs[i];
    } else if (exponent < 0) {
      layout.beforeSize = static_cast<std::uint8_t>(1 - exponent);
      for (int i = 0; i < layout.beforeSize; ++i) layout.before[i] = i == 1 ? '.' : '0';
    } else {
      layout.whole = layout.least = static_cast<std::uint8_t>(exponent + 1);
    }
  }
  return out;
}();

/// 10^kLeastExponent and on.
constexpr std::array kBounds{1e-22, 1e-21, 1e-20, 1e-19, 1e-18, 1e-17, 1e-16, 1e-15, 1e-14, 1e-13,
                             1e-12, 1e-11, 1e-10, 1e-9,  1e-8,  1e-7,  1e-6,  1e-5,  1e-4,  1e-3,
                             1e-2,  1e-1,  1e0,   1e1,   1e2,   1e3,   1e4,   1e5,   1e6};
/// The decimal exponent of a number from 1e-21 to 1e6, of binary exponent `binary`.
inline int exponentOf(double v, int binary) {
  const int guess = binary * 315653 >> 20;  // floor(binary * log10(2)): the exponent or one less
  return guess + (v >= kBounds[static_cast<std::size_t>(guess + 1 - kLeastExponent)]);
}

/// Writes digits below 1,000,000, the last `Decimals` of them behind the point; no branch, since nobody knows how many
/// there are before it.
template <int Decimals>
char* putShort(char* to, std::uint32_t digits) {
  static_assert(Decimals == 2 || Decimals == 3);
  constexpr std::uint32_t kUnit = Decimals == 2 ? 100 : 1000, kToFour = Decimals == 2 ? 100 : 10;
  const auto four = [](std::uint32_t v) { return static_cast<std::uint32_t>(pair(v / 100) | pair(v % 100) << 16); };
  const std::uint32_t whole = four(digits / kUnit), part = four(digits % kUnit * kToFour);
  const int zeros = std::min(3, std::countr_zero(whole ^ 0x30303030) / 8);  // not written
  const std::uint32_t first = whole >> 8 * zeros;
  std::memcpy(to, &first, sizeof first);
  to += 4 - zeros;
  *to = '.';
  std::memcpy(to + 1, &part, sizeof part);
  return to + 1 + Decimals;
}

}  // namespace

char* putFixed(char* to, double v, int decimals, DoubleRange doubles) {
  constexpr int kFastDecimals = 9;
  constexpr std::uint64_t kShortEnd = 1000000;
  if (std::isnan(v))
    return static_cast<char*>(std::memcpy(to, "nan", 3)) + 3;  // its sign means nothing, and clients do not read it
  if (!(v >= doubles.begin && v < doubles.end)) v = static_cast<float>(v);
  if (!(std::abs(v) < 0x1p31) || decimals < 0 || decimals > kFastDecimals)
    return putSlowly(to, kFixedRoom, v, std::chars_format::fixed, std::clamp(decimals, 0, 60));
  if (std::signbit(v)) *to++ = '-';
  std::uint64_t digits = scaled(v, decimals);
  if (digits < kShortEnd && decimals == 2) return putShort<2>(to, static_cast<std::uint32_t>(digits));
  if (digits < kShortEnd && decimals == 3) return putShort<3>(to, static_cast<std::uint32_t>(digits));
  const int whole = std::max(countDigits(digits) - decimals, 1);
  if (decimals > 0) {
    putDigits(to + whole + 1 + decimals, digits, decimals);
    to[whole] = '.';
  }
  putDigits(to + whole, digits, whole);
  return to + whole + (decimals > 0 ? decimals + 1 : 0);
}

char* putGeneral(char* to, double v) {
  constexpr std::uint64_t kEnd = 1000000;              // behind the largest number of six digits
  constexpr int kLeastBinary = -69, kMostBinary = 18;  // 1.7e-21 and on, below 524,288
  const double size = std::abs(v);
  const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(size) >> 52) - 1023;
  const bool fast = binary >= kLeastBinary && binary <= kMostBinary;
  if (!fast && size != 0) return putSlowly(to, kGeneralRoom, v, std::chars_format::general, kGeneralDigits);
  *to = '-';
  to += std::signbit(v);
  if (!fast) return *to = '0', to + 1;
  int exponent = exponentOf(size, binary);
  std::uint64_t digits = 0;
  const int decimals = kGeneralDigits - 1 - exponent;
  if (!nearest(size * kPowers[static_cast<std::size_t>(decimals)], digits)) digits = scaledExactly(size, decimals);
  if (digits == kEnd) digits /= 10, ++exponent;  // rounded up to the next power of ten
  const auto high = static_cast<std::uint32_t>(digits) / 10000, low = static_cast<std::uint32_t>(digits) % 10000;
  // The first digit is the lowest byte.
  const std::uint64_t text = pair(high) | pair(low / 100) << 16 | pair(low % 100) << 32;
  const int count =
      8 - static_cast<int>(static_cast<unsigned>(std::countl_zero((text ^ kZeros) | 1)) / 8);  // one at least

  // No branch here: where the digits of a matrix have their point is anybody's guess. What is written too much is
  // written over.
  const Layout& layout = kLayouts[static_cast<std::size_t>(exponent - kLeastExponent)];
  std::memcpy(to, layout.before, sizeof layout.before);
  to += layout.beforeSize;
  const std::uint64_t behindPoint = text >> 8 * layout.whole;
  std::memcpy(to, &text, sizeof text);
  std::memcpy(to + layout.whole + 1, &behindPoint, sizeof behindPoint);
  to[layout.whole] = '.';
  to += std::max<int>(count, layout.least) + (count > layout.whole);
  std::memcpy(to, layout.behind, sizeof layout.behind);
  return to + layout.behindSize;
}

void appendFixed(std::string& out, double v, int decimals, DoubleRange doubles) {
  char buffer[kFixedRoom];
  out.append(buffer, putFixed(buffer, v, decimals, doubles));
}

namespace {
/// Reads numbers as most are written; false for all others.
bool readShort(std::string_view text, double& v) {
  // Up to 15 digits are a whole number that a double holds, and so is 10^decimals up to 22: their quotient is rounded
  // once, as it has to be.
  constexpr std::size_t kExactDigits = 15;
  const bool negative = text.starts_with('-');
  const std::string_view digits = text.substr(negative);
  if (digits.empty() || digits.size() > kExactDigits + 1) return false;
  std::uint64_t whole = 0;
  std::size_t at = 0, point = digits.size();
  for (; at < digits.size(); ++at) {
    const auto digit = static_cast<unsigned>(digits[at] - '0');
    if (digit < 10)
      whole = whole * 10 + digit;
    else if (digits[at] == '.' && point == digits.size())
      point = at;
    else
      break;
  }
  const bool pointed = point < digits.size();
  const std::size_t count = digits.size() - pointed;
  if (at != digits.size() || count == 0 || count > kExactDigits) return false;
  v = static_cast<double>(whole) / kPowers[pointed ? digits.size() - point - 1 : 0];
  if (negative) v = -v;
  return true;
}

/// As C's strtod; returns how many bytes it read.
std::size_t readSlowly(std::string_view text, double& v) {
  // strtod wants a terminated string; numbers are short.
  char buffer[64];
  const std::string all(text.size() < sizeof buffer ? std::string_view() : text);
  text.copy(buffer, sizeof buffer - 1);
  buffer[std::min(text.size(), sizeof buffer - 1)] = 0;
  const char* begin = all.empty() ? buffer : all.c_str();
  char* end = nullptr;
  v = std::strtod(begin, &end);
  return static_cast<std::size_t>(end - begin);
}
}  // namespace

double readNumber(std::string_view text) {
  double v = 0;
  if (!readShort(text, v)) readSlowly(text, v);
  return v;
}

bool readWholeNumber(std::string_view text, double& v) {
  if (readShort(text, v)) return true;
  double read = 0;
  const bool blank = !text.empty() && std::isspace(static_cast<unsigned char>(text.front()));
  if (text.empty() || blank || readSlowly(text, read) != text.size()) return false;
  v = read;
  return true;
}

void ByteWriter::integer(std::int64_t v) {
  char* to = room(kGeneralRoom);
  end(std::to_chars(to, to + kGeneralRoom, v).ptr);
}

void ByteWriter::flush() {
  out_.append(block_, at_);
  at_ = block_;
}

}  // namespace spark
