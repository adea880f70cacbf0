#include "range_coder.h"

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

/// Bits of which so many in 1000 are set.
std::vector<bool> someBits(int inThousand, std::size_t count) {
  std::mt19937 random(5);
  std::vector<bool> out;
  while (out.size() < count) out.push_back(static_cast<int>(random() % 1000) < inThousand);
  return out;
}
}  // namespace

TEST_CASE("Bits are the same after writing and reading, and take about as many bytes as they tell") {
  constexpr std::size_t kCount = 20000;
  for (const int inThousand : {0, 1, 20, 300, 500, 999, 1000}) {
    CAPTURE(inThousand);
    const std::vector<bool> bits = someBits(inThousand, kCount);
    std::size_t wrong = 0;
    const std::string bytes = writeAndRead([&](auto& coder) {
      Chance chance;
      for (const bool bit : bits) wrong += coder.bit(chance, bit) != bit;
    });
    CHECK(wrong == 0);
    const double p = inThousand / 1000.0;
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

TEST_CASE("Numbers are the same after writing and reading, also the least and the largest") {
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

TEST_CASE("Numbers near to zero take few bits once they were seen often") {
  const std::string bytes = writeAndRead([](auto& coder) {
    Number number;
    for (int i = 0; i < 8000; ++i) CHECK(number.code(coder, i % 100 == 0 ? 1 : 0) == (i % 100 == 0));
  });
  CHECK(bytes.size() < 120);
}

TEST_CASE("Nothing takes no byte") {
  CHECK(writeAndRead([](auto&) {}).empty());
}

TEST_CASE("Bytes that end early or go on are an error") {
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
