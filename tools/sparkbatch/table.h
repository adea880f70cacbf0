#pragma once
/// \file
/// The results: one file with a row a run, and beside it `<file>.batch`, which says what the batch is.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "format.h"
#include "row.h"

namespace sparkbatch {

/// The table and its file. Rows are written as they come, each with one write; what is there at any moment is a whole
/// table, but perhaps for its last line. Held by one process at a time.
class Table {
 public:
  /// How to open a file that is there.
  enum class Open { fresh, resume, retry };

  /// `batch`: what must be the same for rows of one table, an object with a sentence's worth of text a key. Throws
  /// spark::Error when the file is there and it is to be fresh, when it is of another batch (says what differs), is no
  /// table, or is in use.
  Table(std::string file, const Json& batch, Open open);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  bool has(std::int64_t run) const { return rows_.count(run) > 0; }
  std::size_t size() const { return rows_.size(); }
  /// Adds a row; when this returns it is in the file. Throws spark::Error.
  void add(Row row);
  /// Puts the rows in order of number and the columns in the order of their first row. To be called when all rows are
  /// there.
  void sort();

 private:
  void lock(const Json& batch, Open open);
  void compare(const Json& before, const Json& batch) const;
  void read(bool retry);
  std::size_t addColumns(const Row& row);
  /// Puts the whole table into the file, in one go.
  void rewrite();
  void openForAppending();
  void write(int file, const std::string& text) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string name_;
  Format format_;
  std::vector<std::string> columns_;
  std::map<std::int64_t, Row> rows_;
  int file_ = -1, lock_ = -1;
};

}  // namespace sparkbatch
