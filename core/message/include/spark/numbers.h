#pragma once
/// \file
/// Converts numbers to text and back with the results of C's printf and atof, in a fraction of their time, because most
/// of a message is numbers.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "spark/abi/spark/numbers.h"
#include "spark/assert.h"

namespace spark {

/// The buffer sizes that putFixed() and putGeneral() need [bytes].
inline constexpr std::size_t kFixedRoom = 400, kGeneralRoom = 32;

/// The range of numbers that are written in double precision: from `begin` to below `end`. All others are rounded to
/// single precision first.
struct DoubleRange {
  double begin = 0, end = 0;
};
/// Every number is written in double precision.
inline constexpr DoubleRange kAllDouble{-std::numeric_limits<double>::infinity(),
                                        std::numeric_limits<double>::infinity()};

/// Writes a number with 0 to 60 decimals as C's %.Nf, with inf and -0.00, but nan always without a sign. `to` must have
/// room for kFixedRoom bytes. Returns the end of the text, which is not terminated.
char* putFixed(char* to, double v, int decimals, DoubleRange doubles = {});
/// Writes a number with six significant digits as C's %g: 0.04, 1e-07, -0, -nan. `to` must have room for kGeneralRoom
/// bytes. Returns the end of the text, which is not terminated.
char* putGeneral(char* to, double v);
/// Appends the text of putFixed().
void appendFixed(std::string& out, double v, int decimals, DoubleRange doubles = {});

/// Reads a number as C's atof: text that is no number is 0, characters behind the number are ignored, and nan, inf and
/// hexadecimal numbers are understood.
double readNumber(std::string_view text);
/// Reads a text that is one number and nothing else. Returns false, and leaves `v` unchanged, for any other text,
/// also with blanks in front.
bool readWholeNumber(std::string_view text, double& v);

/// Appends to a string through a buffer, so that short writes need no check of the string's capacity. The string is
/// complete after flush(), and when the writer is destroyed.
class ByteWriter {
 public:
  /// `out` must outlive the writer and must not be used before the next flush().
  explicit ByteWriter(std::string& out) : out_(out) {}
  /// Flushes.
  ~ByteWriter() { flush(); }
  ByteWriter(const ByteWriter&) = delete;
  ByteWriter& operator=(const ByteWriter&) = delete;

  /// Appends a byte.
  void put(char c) { *room(1) = c, ++at_; }
  /// Appends bytes.
  void put(std::string_view bytes) {
    if (bytes.size() > sizeof block_) return flush(), void(out_.append(bytes));
    std::memcpy(room(bytes.size()), bytes.data(), bytes.size());
    at_ += bytes.size();
  }
  /// Appends the text of putFixed().
  void fixed(double v, int decimals, DoubleRange doubles = {}) {
    end(putFixed(room(kFixedRoom), v, decimals, doubles));
  }
  /// Appends the text of putGeneral().
  void general(double v) { end(putGeneral(room(kGeneralRoom), v)); }
  /// Appends an integer in decimal.
  void integer(std::int64_t v);

  /// Returns a buffer for `n` bytes, at most kMostRoom. The caller writes some of them and passes their end to end().
  char* room(std::size_t n) {
    SPARK_ASSERT(n <= kMostRoom);
    if (static_cast<std::size_t>(block_ + sizeof block_ - at_) < n) flush();
    return at_;
  }
  /// Sets the end of the bytes that were written at room().
  void end(char* at) { at_ = at; }
  /// The size of the buffer [bytes].
  static constexpr std::size_t kMostRoom = 4096;
  /// Moves the contents of the buffer to the string.
  void flush();

 private:
  std::string& out_;
  char block_[kMostRoom];
  char* at_ = block_;
};

}  // namespace spark
