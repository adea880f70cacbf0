#include "range_coder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "spark/error.h"

using namespace spark;
using namespace spark::recorder;

namespace {
/// Calls `code` with a coder that writes and then with one that reads what was written. Returns the bytes.
template <class Code>
std::string writeAndRead(Code code) {
  std::string bytes;
  RangeWriter writer(bytes);
  code(writer);
  writer.finish();
  RangeReader reader(bytes);
  code(reader);
  CHECK_NOTHROW(reader.finish());
  return bytes;
}
}  // namespace

TEST_CASE("Bits are the same after writing and reading, and their size is close to their entropy") {
  constexpr std::size_t kCount = 20000;
  for (const double p : {0., 0.001, 0.02, 0.3, 0.5, 0.999, 1.}) {
    CAPTURE(p);
    std::mt19937 random(5);
    std::bernoulli_distribution isSet(p);
    std::vector<bool> bits(kCount);
    std::generate(bits.begin(), bits.end(), [&] { return isSet(random); });
    std::size_t wrong = 0;
    const std::string bytes = writeAndRead([&](auto& coder) {
      Chance chance;
      for (const bool bit : bits) wrong += coder.bit(chance, bit) != bit;
    });
    CHECK(wrong == 0);
    const double entropy = p == 0 || p == 1 ? 0 : -(p * std::log2(p) + (1 - p) * std::log2(1 - p));
    CHECK(static_cast<double>(bytes.size()) <= 1.05 * entropy * kCount / 8 + 40);
  }
}

TEST_CASE("Bits without a chance take a bit each") {
  const std::uint64_t values[] = {0, 1, 0x0123456789abcdef, std::numeric_limits<std::uint64_t>::max()};
  const std::string bytes = writeAndRead([&](auto& coder) {
    for (const std::uint64_t value : values) CHECK(coder.bits(64, value) == value);
  });
  CHECK(bytes.size() <= 8 * std::size(values) + 1);
}

TEST_CASE("Numbers are the same after writing and reading, including the smallest and the largest") {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min(), kMost = std::numeric_limits<std::int64_t>::max();
  std::vector<std::int64_t> numbers{0, 1, -1, kMost, -kMost, kLeast, kLeast + 1};
  for (int bit = 1; bit < 63; ++bit)
    for (const std::int64_t off : {-1, 0, 1})
      for (const std::int64_t sign : {-1, 1}) numbers.push_back(sign * ((std::int64_t{1} << bit) + off));
  writeAndRead([&](auto& coder) {
    Number<2, 3> number;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      CAPTURE(numbers[i]);
      CHECK(number.code(coder, numbers[i], i % 2, i % 3) == numbers[i]);
    }
  });
}

TEST_CASE("Small numbers take few bits when they are frequent") {
  const std::string bytes = writeAndRead([](auto& coder) {
    Number number;
    for (int i = 0; i < 8000; ++i) CHECK(number.code(coder, i % 100 == 0 ? 1 : 0) == (i % 100 == 0));
  });
  CHECK(bytes.size() < 120);
}

TEST_CASE("An empty message takes no bytes") {
  CHECK(writeAndRead([](auto&) {}).empty());
}

TEST_CASE("Truncated messages and trailing bytes are errors") {
  std::string bytes;
  RangeWriter writer(bytes);
  for (std::uint64_t i = 0; i < 4; ++i) writer.bits(64, ~i);
  writer.finish();
  const auto read = [](std::string_view from) {
    RangeReader reader(from);
    for (int i = 0; i < 4; ++i) reader.bits(64);
    reader.finish();
  };
  CHECK_NOTHROW(read(bytes));
  CHECK_THROWS_AS(read(std::string_view(bytes).substr(0, bytes.size() / 2)), Error);
  CHECK_THROWS_AS(read(bytes + "more and more"), Error);
}

TEST_CASE("A number with more than 64 bits is an error") {
  std::string bytes;
  RangeWriter writer(bytes);
  Symbol<7> length;
  length.code(writer, 100);
  writer.finish();
  RangeReader reader(bytes);
  Number number;
  CHECK_THROWS_AS(number.code(reader), Error);
}
