#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace spark {

/// A recorded game: one monitor message a line, with what was drawn in front of it, `[1, 0, -3]...`. Lines that can be
/// none are left out. A message is an S-expression, or an array in JSON, which begins with two brackets.
class LogFile {
 public:
  static constexpr std::size_t kLongest = 8u << 20;  ///< bytes of a line; longer ones are left out
  static constexpr std::size_t kMost = 1u << 20;     ///< records; 58 hours at 0.2 s

  /// Reads through the file. Throws Error: it cannot be read, or holds no record.
  explicit LogFile(const std::string& path);

  std::size_t size() const { return records_.size(); }
  /// Lines that are no records.
  std::size_t leftOut() const { return leftOut_; }
  /// The text of record i; "" when the file has changed meanwhile.
  const std::string& read(std::size_t i);
  /// What stands in front of the text of record i, as it was written.
  const std::string& readDrawings(std::size_t i);
  /// The last full record that is not behind i; 0 when there is none.
  std::size_t fullBefore(std::size_t i) const { return records_.at(i).full; }
  /// True when there are draw commands in front of record i.
  bool hasDrawings(std::size_t i) const { return records_.at(i).drawn > 0; }

 private:
  struct Record {
    std::uint64_t offset = 0;           ///< of its text
    std::uint32_t size = 0, drawn = 0;  ///< bytes of its text, and of the draw commands in front of it
    std::uint32_t full = 0;             ///< the last full record that is not behind it; 0 when there is none
  };
  void addLine(std::uint64_t offset, std::string_view line);
  const std::string& read(std::uint64_t offset, std::size_t size);
  std::ifstream in_;
  std::vector<Record> records_;
  std::size_t leftOut_ = 0;
  std::string line_;
};

}  // namespace spark
