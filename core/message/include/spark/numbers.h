#pragma once
/// \file
/// Numbers as text and back, exactly as C's printf and atof have them, at a tenth of their cost: messages are mostly
/// numbers.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "spark/abi/spark/numbers.h"
#include "spark/assert.h"

namespace spark {

/// Bytes that putFixed() and putGeneral() need.
inline constexpr std::size_t kFixedRoom = 400, kGeneralRoom = 32;

/// The numbers that are written in double precision: from `begin` to below `end`. All others are rounded to single
/// precision first.
struct DoubleRange {
  double begin = 0, end = 0;
};
inline constexpr DoubleRange kAllDouble{-std::numeric_limits<double>::infinity(),
                                        std::numeric_limits<double>::infinity()};

/// Writes a number with 0 to 60 fixed decimals as C prints it: -0.00, inf, and nan without a sign. `to` has room for
/// kFixedRoom bytes. Returns the end.
char* putFixed(char* to, double v, int decimals, DoubleRange doubles = {});
/// Writes a number with six significant digits as C's %g: 0.04, 1e-07, -0, -nan. `to` has room for
/// kGeneralRoom bytes. Returns the end.
char* putGeneral(char* to, double v);
/// Appends what putFixed() writes.
void appendFixed(std::string& out, double v, int decimals, DoubleRange doubles = {});

/// Reads a number as C's atof: garbage is 0, trailing junk is ignored, nan, inf and hexadecimal digits are known.
double readNumber(std::string_view text);
/// Reads a number that is all of the text: as readNumber, but false, and `v` untouched, where that would pass over
/// something or make 0 of garbage.
bool readWholeNumber(std::string_view text, double& v);

/// Appends to a string in large pieces: short writes cost no test for room each. What was written is there when the
/// writer ends.
class ByteWriter {
 public:
  /// `out` must outlive the writer and not be touched meanwhile.
  explicit ByteWriter(std::string& out) : out_(out) {}
  ~ByteWriter() { flush(); }
  ByteWriter(const ByteWriter&) = delete;
  ByteWriter& operator=(const ByteWriter&) = delete;

  void put(char c) { *room(1) = c, ++at_; }
  void put(std::string_view bytes) {
    if (bytes.size() > sizeof block_) return flush(), void(out_.append(bytes));
    std::memcpy(room(bytes.size()), bytes.data(), bytes.size());
    at_ += bytes.size();
  }
  void fixed(double v, int decimals, DoubleRange doubles = {}) {
    end(putFixed(room(kFixedRoom), v, decimals, doubles));
  }
  void general(double v) { end(putGeneral(room(kGeneralRoom), v)); }
  void integer(std::int64_t v);

  /// Where `n` bytes can be written, at most kMostRoom; then end() says up to where they were.
  char* room(std::size_t n) {
    SPARK_ASSERT(n <= kMostRoom);
    if (static_cast<std::size_t>(block_ + sizeof block_ - at_) < n) flush();
    return at_;
  }
  void end(char* at) { at_ = at; }
  static constexpr std::size_t kMostRoom = 4096;
  /// Appends what was written so far.
  void flush();

 private:
  std::string& out_;
  char block_[kMostRoom];
  char* at_ = block_;
};

}  // namespace spark
