#include "spark/numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

// How numbers become digits. The digits of v up to its k-th decimal are the integer nearest to v * 10^k. In double
// precision that product has an error below 1e-6 (see nearest()), so its rounding is certain unless it is that near to
// a tie. Near a tie the product is computed exactly in 128 bits: a double is m * 2^e with an integer m < 2^53, so v *
// 10^k = (m * 5^k) * 2^(e + k), where m * 5^k has at most 116 bits for k <= 27; a shift divides by the power of two.
// Ties round to the even digit, as in C. Numbers outside of the range of this method are written by std::to_chars.

namespace spark {

namespace {

__extension__ using Wide = unsigned __int128;

static_assert(std::endian::native == std::endian::little,
              "digits are collected in a word with the first digit in its lowest byte");

constexpr int kGeneralDigits = 6;                    // significant digits of %g
constexpr std::uint64_t kSixZeros = 0x303030303030;  // "000000" as a word
constexpr std::uint32_t kFourZeros = 0x30303030;     // "0000"
constexpr int kMaxDecimals = 27;                     // 5^27 < 2^63

/// 5^k.
constexpr auto kPowersOfFive = [] {
  std::array<std::uint64_t, kMaxDecimals + 1> out{1};
  for (std::size_t k = 1; k < out.size(); ++k) out[k] = out[k - 1] * 5;
  return out;
}();
/// 10^k as integers, all that fit 64 bits.
constexpr auto kPowersOfTen = [] {
  std::array<std::uint64_t, 20> out{1};
  for (std::size_t k = 1; k < out.size(); ++k) out[k] = out[k - 1] * 10;
  return out;
}();
/// 10^k as doubles: exact up to 1e22, rounded from there on.
constexpr std::array kDoublePowersOfTen{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,
                                        1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19,
                                        1e20, 1e21, 1e22, 1e23, 1e24, 1e25, 1e26, 1e27};
/// The texts "00" to "99" one after the other: two digits cost one look-up. Alexandrescu, "Three Optimization Tips for
/// C++", 2012.
constexpr auto kDigitPairs = [] {
  std::array<char, 200> out{};
  for (std::size_t i = 0; i < 100; ++i)
    out[2 * i] = static_cast<char>('0' + i / 10), out[2 * i + 1] = static_cast<char>('0' + i % 10);
  return out;
}();

/// |v| * 10^k, rounded exactly to the nearest integer, ties to even. Requires |v| < 2^31, 0 <= k <= kMaxDecimals and a
/// result below 2^63.
[[gnu::noinline]] std::uint64_t scaledExactly(double v, int k) {
  constexpr int kMantissaBits = 52;
  constexpr int kBias = 1075;  // of the exponent of m * 2^e with an integer m
  constexpr int kMaxShift = 120;
  // v = mantissa * 2^(exponent - kBias). Subnormal numbers have exponent 0 and no hidden bit.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(v) & ~(1ull << 63);
  const auto exponent = static_cast<int>(bits >> kMantissaBits);
  const std::uint64_t fraction = bits & ((1ull << kMantissaBits) - 1);
  const std::uint64_t mantissa = exponent > 0 ? fraction | 1ull << kMantissaBits : fraction;
  const int shift = kBias - std::max(exponent, 1) - k;
  if (shift >= kMaxShift) return 0;  // less than a half: the product has at most 116 bits
  const Wide product = static_cast<Wide>(mantissa) * kPowersOfFive[k];
  const auto whole = static_cast<std::uint64_t>(product >> shift);
  const Wide rest = product & ((static_cast<Wide>(1) << shift) - 1), half = static_cast<Wide>(1) << (shift - 1);
  return whole + (rest > half || (rest == half && whole % 2));
}

/// Rounds `product`, which must be below 2^30, to the nearest integer. Returns false if it is too near to a tie: up to
/// two roundings, of the power of ten and of the product, leave an error of up to 2^30 * 2^-52 < 1e-6.
inline bool nearest(double product, std::uint64_t& whole) {
  constexpr double kMargin = 1e-6;
  // From 2^52 on doubles are integers, so the sum is rounded to one, and the lowest bits of its mantissa are that
  // number.
  constexpr double kUnits = 0x1p52;
  const double rounded = product + kUnits;
  whole = std::bit_cast<std::uint64_t>(rounded) ^ std::bit_cast<std::uint64_t>(kUnits);
  return std::abs(product - (rounded - kUnits)) < 0.5 - kMargin;
}

/// As scaledExactly(), but in double precision if its rounding is certain.
inline std::uint64_t scaled(double v, int k) {
  const double product = std::abs(v) * kDoublePowersOfTen[k];
  std::uint64_t whole = 0;
  return product < 0x1p30 && nearest(product, whole) ? whole : scaledExactly(v, k);
}

/// The number of decimal digits; 0 for 0. The integer logarithm of Anderson, "Bit Twiddling Hacks".
int countDigits(std::uint64_t v) {
  const std::uint32_t bits = 64 - static_cast<std::uint32_t>(std::countl_zero(v | 1));
  const std::uint32_t guess = bits * 1233 >> 12;  // log10(2) = 1233 / 4096
  return static_cast<int>(guess + (v >= kPowersOfTen[guess]));
}

/// Writes the last `count` digits of `v` so that they end before `end`, and removes them from `v`.
void putDigits(char* end, std::uint64_t& v, int count) {
  for (; count >= 2; count -= 2, v /= 100) std::memcpy(end -= 2, &kDigitPairs[2 * (v % 100)], 2);
  if (count > 0) *--end = static_cast<char>('0' + v % 10), v /= 10;
}

/// The two digits of v < 100 as a word, in the order of memory.
std::uint64_t digitPair(std::uint32_t v) {
  std::uint16_t out;
  std::memcpy(&out, &kDigitPairs[2 * v], sizeof out);
  return out;
}

/// Writes any number by the standard library.
template <class... Format>
char* putWithCharconv(char* to, std::size_t room, double v, Format... format) {
  return std::to_chars(to, to + room, v, format...).ptr;
}

/// How %g writes the numbers of one decimal exponent: "before", digits, point, digits, "behind".
struct Layout {
  char before[8] = {};  ///< "0.000" in front of the digits of small numbers
  char behind[4] = {};  ///< the exponent, as "e-07"
  std::uint8_t beforeSize = 0;
  std::uint8_t whole = kGeneralDigits;  ///< digits in front of the point
  std::uint8_t least = 0;               ///< digits that are written even if they are trailing zeros
  std::uint8_t behindSize = 0;
};
constexpr int kMinExponent = -22, kMaxExponent = 6;
/// The layouts of kMinExponent to kMaxExponent. %g has an exponent below 1e-4 and from 1e6 on.
constexpr auto kLayouts = [] {
  std::array<Layout, kMaxExponent - kMinExponent + 1> out{};
  for (int exponent = kMinExponent; exponent <= kMaxExponent; ++exponent) {
    Layout& layout = out[exponent - kMinExponent];
    if (exponent < -4 || exponent >= kGeneralDigits) {
      const int size = exponent < 0 ? -exponent : exponent;
      layout.whole = layout.least = 1;
      layout.behind[layout.behindSize++] = 'e';
      layout.behind[layout.behindSize++] = exponent < 0 ? '-' : '+';
      for (const int i : {2 * size, 2 * size + 1}) layout.behind[layout.behindSize++] = kDigitPairs[i];
    } else if (exponent < 0) {
      layout.beforeSize = static_cast<std::uint8_t>(1 - exponent);
      for (int i = 0; i < layout.beforeSize; ++i) layout.before[i] = i == 1 ? '.' : '0';
    } else {
      layout.whole = layout.least = static_cast<std::uint8_t>(exponent + 1);
    }
  }
  return out;
}();

/// 10^kMinExponent to 10^kMaxExponent.
constexpr std::array kBounds{1e-22, 1e-21, 1e-20, 1e-19, 1e-18, 1e-17, 1e-16, 1e-15, 1e-14, 1e-13,
                             1e-12, 1e-11, 1e-10, 1e-9,  1e-8,  1e-7,  1e-6,  1e-5,  1e-4,  1e-3,
                             1e-2,  1e-1,  1e0,   1e1,   1e2,   1e3,   1e4,   1e5,   1e6};
/// The decimal exponent of a number from 1e-21 to 1e6 with the binary exponent `binary`.
inline int decimalExponent(double v, int binary) {
  const int guess = binary * 315653 >> 20;  // floor(binary * log10(2)): the exponent, or one less
  return guess + (v >= kBounds[guess + 1 - kMinExponent]);
}

/// Writes `digits`, which must be below 1,000,000, with the last `Decimals` of them behind the point. Without branches,
/// because a processor could not predict how many digits are in front of the point.
template <int Decimals>
char* putShort(char* to, std::uint32_t digits) {
  static_assert(Decimals == 2 || Decimals == 3);
  constexpr std::uint32_t kUnit = Decimals == 2 ? 100 : 1000, kToFour = Decimals == 2 ? 100 : 10;
  const auto fourDigits = [](std::uint32_t v) {
    return static_cast<std::uint32_t>(digitPair(v / 100) | digitPair(v % 100) << 16);
  };
  const std::uint32_t whole = fourDigits(digits / kUnit), part = fourDigits(digits % kUnit * kToFour);
  // Shift out the leading zeros, all but the last digit.
  const int zeros = std::min(3, std::countr_zero(whole ^ kFourZeros) / 8);
  const std::uint32_t first = whole >> 8 * zeros;
  std::memcpy(to, &first, sizeof first);
  to += 4 - zeros;
  *to = '.';
  std::memcpy(to + 1, &part, sizeof part);
  return to + 1 + Decimals;
}

}  // namespace

char* putFixed(char* to, double v, int decimals, DoubleRange doubles) {
  constexpr int kFastDecimals = 9;  // 2^31 * 10^9 < 2^63
  constexpr int kLastDecimals = 60;
  constexpr std::uint64_t kShortEnd = 1000000;
  constexpr std::string_view kNan = "nan";  // its sign has no meaning, and clients do not read it
  if (std::isnan(v)) return std::copy(kNan.begin(), kNan.end(), to);
  if (!(v >= doubles.begin && v < doubles.end)) v = static_cast<float>(v);
  if (!(std::abs(v) < 0x1p31) || decimals < 0 || decimals > kFastDecimals)
    return putWithCharconv(to, kFixedRoom, v, std::chars_format::fixed, std::clamp(decimals, 0, kLastDecimals));
  if (std::signbit(v)) *to++ = '-';
  // Nearly all numbers of messages have two or three decimals and few digits.
  std::uint64_t digits = scaled(v, decimals);
  if (digits < kShortEnd && decimals == 2) return putShort<2>(to, static_cast<std::uint32_t>(digits));
  if (digits < kShortEnd && decimals == 3) return putShort<3>(to, static_cast<std::uint32_t>(digits));
  // From the last digit to the first.
  const int whole = std::max(countDigits(digits) - decimals, 1);
  if (decimals > 0) {
    putDigits(to + whole + 1 + decimals, digits, decimals);
    to[whole] = '.';
  }
  putDigits(to + whole, digits, whole);
  return to + whole + (decimals > 0 ? decimals + 1 : 0);
}

char* putGeneral(char* to, double v) {
  constexpr std::uint64_t kEnd = 1000000;           // the first number of seven digits
  constexpr int kMinBinary = -69, kMaxBinary = 18;  // from 1.7e-21 on, below 524,288
  const double size = std::abs(v);
  const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(size) >> 52) - 1023;
  const bool fast = binary >= kMinBinary && binary <= kMaxBinary;
  if (!fast && size != 0) return putWithCharconv(to, kGeneralRoom, v, std::chars_format::general, kGeneralDigits);
  *to = '-';
  to += std::signbit(v);
  if (!fast) return *to = '0', to + 1;

  // The six significant digits as an integer.
  int exponent = decimalExponent(size, binary);
  std::uint64_t digits = 0;
  const int decimals = kGeneralDigits - 1 - exponent;
  if (!nearest(size * kDoublePowersOfTen[decimals], digits)) digits = scaledExactly(size, decimals);
  if (digits == kEnd) digits /= 10, ++exponent;  // rounded up to the next power of ten

  // The digits as text, the first one in the lowest byte, and their number without trailing zeros.
  const auto high = static_cast<std::uint32_t>(digits) / 10000, low = static_cast<std::uint32_t>(digits) % 10000;
  const std::uint64_t text = digitPair(high) | digitPair(low / 100) << 16 | digitPair(low % 100) << 32;
  const auto leadingZeros = static_cast<std::uint32_t>(std::countl_zero((text ^ kSixZeros) | 1));
  const int count = 8 - static_cast<int>(leadingZeros / 8);  // at least one

  // The layout is filled in without branches, because a processor could not predict the positions of the decimal points
  // in a matrix. Each piece is copied with its full length, and the next one overwrites the excess.
  const Layout& layout = kLayouts[exponent - kMinExponent];
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
/// Reads a number of at most 15 digits without exponent. Returns false for any other text. Clinger, "How to Read
/// Floating Point Numbers Accurately", 1990: a double holds up to 15 digits and powers of ten up to 10^22 exactly, so
/// their quotient is rounded once, as it should be.
bool readShort(std::string_view text, double& v) {
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
  const bool hasPoint = point < digits.size();
  const std::size_t count = digits.size() - hasPoint;
  if (at != digits.size() || count == 0 || count > kExactDigits) return false;
  v = static_cast<double>(whole) / kDoublePowersOfTen[hasPoint ? digits.size() - point - 1 : 0];
  if (negative) v = -v;
  return true;
}

/// Reads a number by C's strtod. Returns the number of bytes read.
std::size_t readWithStrtod(std::string_view text, double& v) {
  // strtod needs a terminated string. Numbers are short, so that most are copied to the stack.
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
  if (!readShort(text, v)) readWithStrtod(text, v);
  return v;
}

bool readWholeNumber(std::string_view text, double& v) {
  if (readShort(text, v)) return true;
  double read = 0;
  // strtod skips blanks in front.
  const bool blank = !text.empty() && std::isspace(static_cast<unsigned char>(text.front()));
  if (text.empty() || blank || readWithStrtod(text, read) != text.size()) return false;
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
