#pragma once
/// \file
/// The format of a table: CSV with a header, or a JSON object per line. A row is always one line.

#include <string>
#include <string_view>
#include <vector>

#include "row.h"

namespace sparkbatch {

/// CSV if the name of the file ends with .csv, otherwise JSON lines.
class Format {
 public:
  explicit Format(const std::string& file);
  /// True if the first line has the names of the columns.
  bool hasHeader() const { return csv_; }
  /// The first line, with its line break; "" if there is none.
  std::string header(const std::vector<std::string>& columns) const;
  /// The line of a row, with its line break.
  std::string line(const Row& row, const std::vector<std::string>& columns) const;
  /// The names of the columns in a header without line break; none if the format has no header.
  std::vector<std::string> columns(std::string_view header) const;
  /// Parses a line without line break. Values in a CSV file become strings, except `run`. Throws spark::Error.
  Row row(std::string_view line, const std::vector<std::string>& columns) const;

 private:
  bool csv_;
};

}  // namespace sparkbatch
