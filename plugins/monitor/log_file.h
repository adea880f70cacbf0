#pragma once
/// \file
/// Random access to the records of a log.

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace spark {

/// A recorded game: each line is a record, one monitor message, perhaps after draw commands, `[1, 0, -3]...`. A message
/// is an S-expression, or a JSON array, which begins with two brackets. Lines that are neither are skipped. Only an
/// index is in memory.
class LogFile {
 public:
  static constexpr std::size_t kMaxLineBytes = 8u << 20;  ///< longer lines are skipped
  static constexpr std::size_t kMaxRecords = 1u << 20;    ///< further ones are skipped; 58 hours at 0.2 s

  /// Reads the file and builds the index. Throws Error if it cannot be read or has no record.
  explicit LogFile(const std::string& path);

  /// Number of records, at least 1.
  std::size_t size() const { return records_.size(); }
  /// Number of lines that were skipped.
  std::size_t skipped() const { return skipped_; }
  /// The message of record i; "" if the file was truncated since it was opened. Valid until the next read.
  const std::string& read(std::size_t i);
  /// The draw commands of record i, as they are in the file. Valid until the next read.
  const std::string& readDrawings(std::size_t i);
  /// Index of the last full record at or before i; 0 if there is none.
  std::size_t fullBefore(std::size_t i) const { return records_.at(i).full; }
  /// True if record i has draw commands.
  bool hasDrawings(std::size_t i) const { return records_.at(i).drawn > 0; }

 private:
  struct Record {
    std::uint64_t offset = 0;           ///< of the message, in bytes
    std::uint32_t size = 0, drawn = 0;  ///< bytes of the message, and of the draw commands before it
    std::uint32_t full = 0;             ///< as fullBefore()
  };
  void addLine(std::uint64_t offset, std::string_view line);
  const std::string& read(std::uint64_t offset, std::size_t size);
  std::ifstream in_;
  std::vector<Record> records_;
  std::size_t skipped_ = 0;
  std::string line_;  ///< the text that was read last
};

}  // namespace spark
