#include "file_log_sink.h"

#include <spdlog/sinks/rotating_file_sink.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "api/descriptors.h"
#include "spark/error.h"
#include "spark/output_file.h"

namespace spark {

namespace {
/// Throws Error unless `file` is a regular file or does not exist. Others may block when they are opened, as a FIFO
/// does, or cannot be renamed.
void requireRegular(const std::string& file) {
  namespace fs = std::filesystem;
  if (file.find('\0') != std::string::npos)
    throw Error(fmt::format("file: expected a name without NUL bytes, found one behind '{}'", file.c_str()));
  std::error_code ec;
  const fs::file_type type = fs::status(file, ec).type();
  if (type == fs::file_type::regular || type == fs::file_type::not_found || type == fs::file_type::none) return;
  const char* const found = type == fs::file_type::directory   ? "a folder"
                            : type == fs::file_type::fifo      ? "a FIFO"
                            : type == fs::file_type::socket    ? "a socket"
                            : type == fs::file_type::character ? "a device or terminal"
                                                               : "a special file";
  throw Error(fmt::format("file: expected a regular file or a new one, found {}: {}", found, file));
}

/// True if the file begins as a text does, which a log may continue.
bool isText(const std::string& file) {
  std::array<char, 4096> begin;
  std::ifstream in(file, std::ios::binary);
  in.read(begin.data(), begin.size());
  return std::none_of(begin.begin(), begin.begin() + in.gcount(),
                      [](char c) { return (c >= 0 && c < ' ' && !std::isspace(c)) || c == 127; });
}
}  // namespace

void FileLogSink::describe(Description<FileLogSink>& d) {
  d.doc("Writes the log to a file, and begins another one when it is full.");
  d.property("file", &FileLogSink::file, &FileLogSink::setFile)
      .ofProcess()
      .doc("The file, which is continued; empty: none.");
  d.property("maxSize", &FileLogSink::maxSize, &FileLogSink::setMaxSize)
      .unit("bytes")
      .range(1000, 1e12)
      .doc("Size at which the file is renamed and another one begins.");
  d.property("older", &FileLogSink::older, &FileLogSink::setOlder)
      .range(0, 1000)
      .doc("Number of renamed files that are kept: log.1.txt is the latest of log.txt.");
}

std::shared_ptr<spdlog::logger> FileLogSink::open() {
  if (file_.empty()) return nullptr;
  requireRegular(file_);
  if (!outputs::permitted(file_)) {
    kernel().log().warning("{}.file: {} is not written, since a recording names it", path(), file_);
    return nullptr;
  }
  const bool continues = isText(file_);
  outputs::check(file_, "the log", continues);
  if (outputs::isTrial()) return nullptr;
  if (!continues && std::filesystem::exists(file_)) std::filesystem::resize_file(file_, 0);
  spdlog::file_event_handlers events;
  events.after_open = [](const std::string& name, std::FILE* file) {
    closeOnExec(fileno(file));
    outputs::lock(fileno(file), name, "the log");
  };
  return inThread(std::make_shared<spdlog::sinks::rotating_file_sink_st>(
      file_, static_cast<std::size_t>(maxSize_), static_cast<std::size_t>(older_), false, events));
}

void FileLogSink::setFile(std::string file) {
  file_ = std::move(file);
  restart();
}

void FileLogSink::setMaxSize(std::int64_t bytes) {
  maxSize_ = bytes;
  restart();
}

void FileLogSink::setOlder(int files) {
  older_ = files;
  restart();
}

}  // namespace spark
