#include "table.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "spark/error.h"
#include "spark/output_file.h"

namespace sparkbatch {

using spark::Error;
namespace fs = std::filesystem;

namespace {
/// Columns that are always at the end, in this order.
const std::vector<std::string> kLast{"cpuSeconds", "wallSeconds", "error"};

bool isLast(const std::string& column) { return std::find(kLast.begin(), kLast.end(), column) != kLast.end(); }

std::string textOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}
}  // namespace

Table::Table(std::string file, const Json& batch, Open open) : name_(std::move(file)), format_(name_) {
  if (open == Open::fresh && fs::exists(name_))
    throw Error(
        fmt::format("{} is there already. Go on with it with --resume, name another file with --results, or replace it "
                    "with --force.",
                    name_));
  try {
    lock(batch, open);
    if (open != Open::replace && fs::exists(name_)) read(open == Open::retry);
    if (columns_.empty()) addColumns(Row{{"run", 0}});
    rewrite();
  } catch (...) {
    if (lock_ >= 0) close(lock_);
    throw;
  }
}

Table::~Table() {
  if (file_ >= 0) close(file_);
  if (lock_ >= 0) close(lock_);
}

/// Locks the batch file and compares or writes it. The table itself cannot be locked, since rewrite() replaces its
/// file.
void Table::lock(const Json& batch, Open open) {
  const std::string name = name_ + ".batch";
  lock_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) fail(fmt::format("cannot open {}", name));
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0)
    throw Error(fmt::format("{} is in use: another sparkbatch is writing it", name_));
  const std::string text = textOf(name);
  if ((open == Open::resume || open == Open::retry) && fs::exists(name_)) {
    const Json before = Json::parse(text, nullptr, false);
    if (!before.is_object())
      throw Error(
          fmt::format("{} cannot be resumed: {}, which says what its batch is, is missing or damaged", name_, name));
    return compare(before, batch);
  }
  if (open == Open::fresh && !text.empty() && !Json::parse(text, nullptr, false).is_object())
    throw Error(fmt::format("{} is there already and describes no batch; remove it, or replace it with --force", name));
  if (ftruncate(lock_, 0) != 0) fail(fmt::format("cannot write {}", name));
  write(lock_, batch.dump(2) + "\n");
}

void Table::compare(const Json& before, const Json& batch) const {
  const auto shown = [](const Json& all, const std::string& key) {
    return !all.contains(key)     ? std::string("nothing")
           : all[key].is_string() ? all[key].get<std::string>()
                                  : all[key].dump();
  };
  const auto check = [&](const std::string& key) {
    if (shown(before, key) == shown(batch, key)) return;
    throw Error(
        fmt::format("{} is of another batch: its {} is {}, now it would be {}. Say the same as when it was begun, or "
                    "name another file with --results.",
                    name_, key, shown(before, key), shown(batch, key)));
  };
  for (const auto& [key, value] : batch.items()) check(key);
  for (const auto& [key, value] : before.items()) check(key);
}

/// Reads the rows. A last line without a line break was cut off when the program died; it is ignored.
void Table::read(bool retry) {
  const std::string text = textOf(name_);
  std::size_t at = 0, number = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; at = end + 1, end = text.find('\n', at)) {
    const std::string_view line = std::string_view(text).substr(at, end - at);
    ++number;
    try {
      if (format_.hasHeader() && number == 1) {
        columns_ = format_.columns(line);
        continue;
      }
      Row row = format_.row(line, columns_);
      addColumns(row);
      const auto run = row["run"].get<std::int64_t>();
      if (!retry || row.value("end", "") != "error") rows_.insert_or_assign(run, std::move(row));
    } catch (const std::exception& e) {
      throw Error(
          fmt::format("{}:{} is no row of a batch's table. Repair it, or remove the line: its run is then run again.",
                      name_, number),
          e);
    }
  }
}

/// Adds the columns of a row before the last ones. Returns the number of new columns.
std::size_t Table::addColumns(const Row& row) {
  std::size_t added = 0;
  for (const auto& [column, value] : row.items()) {
    if (std::find(columns_.begin(), columns_.end(), column) != columns_.end()) continue;
    columns_.insert(std::find_if(columns_.begin(), columns_.end(), isLast), column);
    ++added;
  }
  std::stable_sort(columns_.begin(), columns_.end(), [](const std::string& a, const std::string& b) {
    const auto place = [](const std::string& c) { return std::find(kLast.begin(), kLast.end(), c) - kLast.begin(); };
    return isLast(a) ? isLast(b) && place(a) < place(b) : isLast(b);
  });
  return added;
}

void Table::add(Row row) {
  const std::size_t added = addColumns(row);
  const auto run = row["run"].get<std::int64_t>();
  const auto at = rows_.insert_or_assign(run, std::move(row)).first;
  if (added > 0 && format_.hasHeader())
    rewrite();  // the header changes
  else
    write(file_, format_.line(at->second, columns_));
}

void Table::sort() {
  columns_.clear();
  for (const auto& [number, row] : rows_) addColumns(row);
  rewrite();
}

void Table::rewrite() {
  std::string text = format_.header(columns_);
  for (const auto& [number, row] : rows_) text += format_.line(row, columns_);
  spark::FileDraft draft(name_, "the table", true);  // the lock says that it is ours
  draft.write(text);
  draft.finish();
  openForAppending();
}

void Table::openForAppending() {
  if (file_ >= 0) close(file_);
  file_ = ::open(name_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) fail(fmt::format("cannot open {}", name_));
}

void Table::write(int file, const std::string& text) const {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = ::write(file, text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(fmt::format("cannot write {}", name_));
    at += static_cast<std::size_t>(n);
  }
}

void Table::fail(const std::string& what) const { throw Error(fmt::format("{}: {}", what, std::strerror(errno))); }

}  // namespace sparkbatch
