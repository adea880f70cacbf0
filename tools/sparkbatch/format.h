#pragma once
/// \file
/// How rows stand in a file: CSV with a header, or a JSON object a line. A row is one line, whatever is in it.

#include <string>
#include <string_view>
#include <vector>

#include "row.h"

namespace sparkbatch {

/// The language of a table's file, by its name: .csv, else JSON lines.
class Format {
 public:
  explicit Format(const std::string& file);
  /// True when the first line names the columns.
  bool hasHeader() const { return csv_; }
  /// Lines end with a line break.
  std::string header(const std::vector<std::string>& columns) const;
  std::string line(const Row& row, const std::vector<std::string>& columns) const;
  /// The names in a header, without its line break.
  std::vector<std::string> columns(std::string_view header) const;
  /// The row in a line. Cells of a CSV become texts, but for `run`. Throws spark::Error that says what is wrong.
  Row row(std::string_view line, const std::vector<std::string>& columns) const;

 private:
  bool csv_;
};

}  // namespace sparkbatch
