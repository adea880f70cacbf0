#pragma once
/// \file
/// Recorded games, as the log player plays them.

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "spark/abi/api/game_log.h"
#include "spark/interface.h"

namespace spark {

/// A recorded game: records in the order of time, each of which is a monitor message, as a monitor would have got it.
/// As a child of a LogPlayer it adds a format of files. Simulation thread.
class IGameLog {
 public:
  SPARK_INTERFACE(IGameLog, 1);
  virtual ~IGameLog() = default;
  /// True if a file with these first bytes, at most 64, is of its format.
  virtual bool recognises(std::string_view begin) const = 0;
  /// Opens a file in place of the one before. Throws Error if it has no record that can be played; then none is open.
  virtual void open(const std::string& file) = 0;
  /// Number of records; 0: no file is open.
  virtual std::size_t size() const = 0;
  /// Time between two records [s]; 0: the file does not tell.
  virtual double interval() const { return 0; }
  /// Simulated time of record i [s]; NaN: the file does not tell.
  virtual double time(std::size_t i) const {
    (void)i;
    return NAN;
  }
  /// The message of record i, an S-expression or a JSON array; "" if it can no longer be read. Valid until the next
  /// read.
  virtual const std::string& read(std::size_t i) = 0;
  /// Draw commands that belong to record i, as a monitor log has them before the message; "": none. Valid until the
  /// next read.
  virtual const std::string& readDrawings(std::size_t i) = 0;
  /// The last record at or before i whose message is complete; 0 if there is none. The others are differences.
  virtual std::size_t fullBefore(std::size_t i) const = 0;
  /// True if record i has draw commands.
  virtual bool hasDrawings(std::size_t i) const = 0;
};

}  // namespace spark
