#pragma once
/// \file
/// Values as bytes: what saved state is made of.

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spark/abi/spark/state_stream.h"
#include "spark/value.h"

namespace spark {

/// Writes state as a sequence of 64-bit words: doubles by their bits, texts with their length.
class StateWriter {
 public:
  /// `keep` false: only the hash is computed, the bytes are not kept.
  explicit StateWriter(bool keep) : keep_(keep) {}
  /// Keeps the bytes, in the memory of `memory`, whose content is lost.
  explicit StateWriter(std::string memory) : keep_(true), bytes_(std::move(memory)) { bytes_.clear(); }
  /// Writes a number, bit by bit.
  void write(double v) { word(std::bit_cast<std::uint64_t>(v)); }
  /// Writes an integer.
  void write(std::int64_t v) { word(static_cast<std::uint64_t>(v)); }
  /// Writes an integer.
  void write(std::uint64_t v) { write(static_cast<std::int64_t>(v)); }
  /// Writes an integer.
  void write(int v) { write(static_cast<std::int64_t>(v)); }
  /// Writes a bool.
  void write(bool v) { write(static_cast<std::int64_t>(v)); }
  /// Writes a text.
  void write(std::string_view v);
  /// Writes a text.
  void write(const std::string& v) { write(std::string_view(v)); }
  /// Writes a text.
  void write(const char* v) { write(std::string_view(v)); }
  /// Writes texts as the list that is their value, without making it.
  void write(const std::vector<std::string>& v);
  /// Writes a value with its type.
  void write(const Value& v);
  /// Writes bytes that are read again but do not count for the hash: data of this process
  /// that a restored run needs, such as its connections. Does nothing unless bytes are kept.
  void aside(std::string_view v);
  /// True if bytes are kept.
  bool keeps() const { return keep_; }
  /// The hash of everything written so far.
  std::uint64_t hash() const;
  /// The bytes written so far; empty unless they are kept.
  const std::string& bytes() const { return bytes_; }
  /// The same, taken out of the writer.
  std::string take() { return std::move(bytes_); }

 private:
  /// Mixes a word into the hash, and keeps its bytes, the lowest first. The multipliers are those of MurmurHash3's
  /// 64-bit finaliser (Appleby). Inline, because a hash of a match is some 100,000 words.
  void word(std::uint64_t w) {
    a_ = std::rotl(a_ ^ (w * 0xff51afd7ed558ccdull), 29) * 0xc4ceb9fe1a85ec53ull + 0x9e3779b97f4a7c15ull;
    ++count_;
    if (keep_) keep(w);
  }
  void keep(std::uint64_t w);
  std::uint64_t a_ = 0x9e3779b97f4a7c15ull, count_ = 0;
  bool keep_;
  std::string bytes_;
};

/// Reads the bytes of a StateWriter, in the order in which they were written (those put aside as texts). Throws Error
/// if the bytes end early or a value has an unknown type.
class StateReader {
 public:
  /// `bytes` must outlive the reader. `branch`: see there.
  explicit StateReader(std::string_view bytes, std::uint64_t branch = 0) : bytes_(bytes), branch_(branch) {}
  /// Not 0: random streams that are read go another way from here, each number its own.
  std::uint64_t branch() const { return branch_; }
  /// Reads a number.
  double readNumber();
  /// Reads an integer.
  std::int64_t readInteger();
  /// Reads a bool.
  bool readBool() { return readInteger() != 0; }
  /// Reads the number of elements that follow, each of them a word at least. Throws Error also where that is more than
  /// is left.
  std::size_t readCount();
  /// Reads a text.
  std::string readString();
  /// Reads a value.
  Value readValue();
  /// True if everything has been read.
  bool atEnd() const { return bytes_.empty(); }

 private:
  std::uint64_t word();
  std::string_view bytes_;
  std::uint64_t branch_;
};

}  // namespace spark
