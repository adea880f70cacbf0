#include "spark/numbers.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

using namespace spark;

namespace {
std::string printed(const char* format, int decimals, double v) {
  char text[512];
  std::snprintf(text, sizeof text, format, decimals, v);
  return text;
}
std::string fixed(double v, int decimals, bool asFloat) {
  char text[kFixedRoom];
  return {text, putFixed(text, v, decimals, asFloat ? DoubleRange{} : kAllDouble)};
}
std::string general(double v) {
  char text[kGeneralRoom];
  return {text, putGeneral(text, v)};
}

/// A number and its neighbours in both precisions.
std::vector<double> around(double v) {
  const auto f = static_cast<float>(v);
  return {v,  std::nextafter(v, INFINITY),  std::nextafter(v, -INFINITY),
          f,  std::nextafterf(f, INFINITY), std::nextafterf(f, -INFINITY),
          -v, std::nextafter(-v, INFINITY)};
}

/// Numbers of every kind: random bits, magnitudes that are usual in messages, ties with few binary places, decimal
/// ties, and powers of ten.
std::vector<double> numbersOf(std::mt19937_64& random) {
  const std::uint64_t bits = random();
  const auto digits = static_cast<double>(static_cast<std::int64_t>(bits >> 20 & 0x1FFFFFF) - 0x1000000);
  const auto power = static_cast<int>(bits & 31);
  std::vector<double> out{std::bit_cast<double>(bits), std::bit_cast<float>(static_cast<std::uint32_t>(bits)),
                          std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), -75 + power)};
  for (const double v : {std::ldexp(digits, -power), digits / std::pow(10.0, power % 12),
                         5 * std::pow(10.0, power - 25), std::pow(10.0, power - 24),
                         (digits + 0.5) * std::pow(10.0, power - 26), std::pow(10.0, power - 24) * (1 - 5e-7)})
    for (const double near : around(v)) out.push_back(near);
  return out;
}
}  // namespace

TEST_CASE("Numbers with fixed decimals are written byte for byte like printf writes them, ties included") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 6000; ++i) {
    const int decimals = i % 11;
    for (const double v : numbersOf(random)) {
      if (std::isnan(v)) continue;
      const std::string found = fixed(v, decimals, false), expected = printed("%.*f", decimals, v);
      if (found != expected) FAIL("expected " << expected << ", found " << found);
      const std::string foundFloat = fixed(v, decimals, true),
                        expectedFloat = printed("%.*f", decimals, static_cast<float>(v));
      if (foundFloat != expectedFloat) FAIL("expected " << expectedFloat << ", found " << foundFloat);
    }
  }
}

TEST_CASE("Numbers with six digits are written byte for byte like printf's %g writes them") {
  std::mt19937_64 random(2);
  for (int i = 0; i < 12000; ++i)
    for (const double v : numbersOf(random)) {
      const std::string found = general(v), expected = printed("%.*g", 6, v);
      if (found != expected) FAIL("expected " << expected << ", found " << found);
    }
}

TEST_CASE("Zeros, powers of ten and non-finite numbers are written with up to six digits") {
  CHECK(general(0) == "0");
  CHECK(general(-0.0) == "-0");
  CHECK(general(1) == "1");
  CHECK(general(-120) == "-120");
  CHECK(general(0.04f) == "0.04");
  CHECK(general(999999.5) == "1e+06");
  CHECK(general(99999.96) == "100000");
  CHECK(general(0.00009999995) == "0.0001");
  CHECK(general(0.00001) == "1e-05");
  CHECK(general(1e300) == "1e+300");
  CHECK(general(5e-324) == "4.94066e-324");
  CHECK(general(NAN) == "nan");
  CHECK(general(-INFINITY) == "-inf");
}

TEST_CASE("Numbers are read with the same bits as by atof") {
  std::mt19937_64 random(3);
  const auto check = [](const std::string& text) {
    const double found = readNumber(text), expected = std::atof(text.c_str());
    if (std::bit_cast<std::uint64_t>(found) != std::bit_cast<std::uint64_t>(expected))
      FAIL(text << ": expected " << expected << ", found " << found);
  };
  for (int i = 0; i < 6000; ++i)
    for (const double v : numbersOf(random)) {
      if (std::abs(v) < 1e17) check(printed("%.*f", i % 9, v));
      check(printed("%.*g", 5 + i % 13, v));
    }
  constexpr std::string_view kLetters = "0123456789.-+ex ";
  for (int i = 0; i < 100000; ++i) {
    std::string text;
    for (std::uint64_t bits = random(), n = bits % 18; n > 0; --n, bits >>= 3)
      text += kLetters[bits / 7 % kLetters.size()];
    check(text);
  }
  for (const char* text : {"",
                           "-",
                           ".",
                           "-.",
                           "-0",
                           "+2",
                           "1.",
                           ".5",
                           "-.5",
                           "1..2",
                           " 7",
                           "7 ",
                           "0x10",
                           "1e3",
                           "nan",
                           "inf",
                           "999999999999999",
                           "9007199254740993",
                           "0.000000000000001",
                           "0.0000000000000001",
                           "123456789012345.6"})
    check(text);
}

TEST_CASE("A text is read as a number only if all of it is the number") {
  for (const char* text : {"0", "-0", "+2", "1.", ".5", "-.5", "0x10", "1e3", "1E-300", "nan", "-inf",
                           "999999999999999", "9007199254740993", "123456789012345678901234567890"}) {
    CAPTURE(text);
    double v = -7;
    CHECK(readWholeNumber(text, v));
    CHECK(std::bit_cast<std::uint64_t>(v) == std::bit_cast<std::uint64_t>(std::atof(text)));
  }
  std::string huge(100, '1');
  huge += 'x';
  for (const std::string_view text : {"", "-", ".", "abc", "1.5x", "1..2", " 7", "7 ", "1e", huge.c_str()}) {
    CAPTURE(text);
    double v = -7;
    CHECK_FALSE(readWholeNumber(text, v));
    CHECK(v == -7);
  }
}

TEST_CASE("A writer writes short and long pieces in order, also beyond the size of its block") {
  const std::string longText(10000, 'x');
  std::string out = "a", expected = "a";
  {
    ByteWriter writer(out);
    for (int i = 0; i < 3000; ++i) {
      writer.put('(');
      writer.put("he1");
      writer.fixed(i / 8.0, 2);
      writer.general(i / 4.0);
      writer.integer(-i);
      expected += "(he1" + printed("%.*f", 2, i / 8.0) + printed("%.*g", 6, i / 4.0) + std::to_string(-i);
      if (i % 1000 == 7) writer.put(longText), expected += longText;
    }
  }
  CHECK(out == expected);
}
