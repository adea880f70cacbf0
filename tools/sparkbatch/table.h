#pragma once
/// \file
/// The results: a file with a row per run, and beside it `<file>.batch`, which describes the batch.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "format.h"
#include "row.h"

namespace sparkbatch {

/// The table and its file. Each row is appended with one write, so the file is a valid table at any time, except
/// perhaps for its last line. A lock allows one process at a time.
class Table {
 public:
  /// How to open the file: `fresh`: it must not exist; `replace`: begin it anew; `resume`: continue it; `retry`: also
  /// remove rows with an error.
  enum class Open { fresh, replace, resume, retry };

  /// `batch`: an object with all settings that must be the same for the rows of a table. Throws spark::Error if the
  /// file exists and must not, belongs to another batch (the text says what differs), is damaged, or is in use.
  Table(std::string file, const Json& batch, Open open);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// True if a run has a row.
  bool has(std::int64_t run) const { return rows_.count(run) > 0; }
  /// Number of rows.
  std::size_t size() const { return rows_.size(); }
  /// Adds a row and writes it to the file. Throws spark::Error.
  void add(Row row);
  /// Sorts the rows by number and the columns by their first row, and rewrites the file. Call it when the table is
  /// complete.
  void sort();

 private:
  void lock(const Json& batch, Open open);
  void compare(const Json& before, const Json& batch) const;
  void read(bool retry);
  std::size_t addColumns(const Row& row);
  /// Replaces the file by the current table, atomically.
  void rewrite();
  void openForAppending();
  void write(int file, const std::string& text) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string name_;
  Format format_;
  std::vector<std::string> columns_;
  std::map<std::int64_t, Row> rows_;
  int file_ = -1, lock_ = -1;  ///< descriptors: the table, for appending; the batch file, which is locked
};

}  // namespace sparkbatch
