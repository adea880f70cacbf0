#pragma once
/// \file
/// Monitor logs as files of text.

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "api/game_log.h"

namespace spark {

/// A recorded game: each line is a record, one monitor message, perhaps after draw commands, `[1, 0, -3]...`. A message
/// is an S-expression, or a JSON array, which begins with two brackets. Lines that are neither are skipped. Only an
/// index is in memory.
class LogFile : public IGameLog {
 public:
  static constexpr std::size_t kMaxLineBytes = 8u << 20;  ///< longer lines are skipped
  static constexpr std::size_t kMaxRecords = 1u << 20;    ///< further ones are skipped; 58 hours at 0.2 s

  bool recognises(std::string_view) const override { return true; }
  /// Reads the file and builds the index.
  void open(const std::string& path) override;
  std::size_t size() const override { return records_.size(); }
  const std::string& read(std::size_t i) override;
  const std::string& readDrawings(std::size_t i) override;
  std::size_t fullBefore(std::size_t i) const override { return records_.at(i).full; }
  bool hasDrawings(std::size_t i) const override { return records_.at(i).drawn > 0; }
  /// Number of lines that were skipped.
  std::size_t skipped() const { return skipped_; }

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
