#include "log_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "spark/error.h"

namespace spark {

namespace {
bool isJson(std::string_view line) { return line.starts_with("[["); }

/// Number of bytes of the draw commands at the start of a line: `[1, 0, ...][...]`.
std::size_t drawCommandBytes(std::string_view line) {
  std::size_t at = 0;
  while (at < line.size() && line[at] == '[') {
    const std::size_t end = line.find(']', at);
    if (end == std::string_view::npos) return line.size();
    at = end + 1;
    while (at < line.size() && (line[at] == ' ' || line[at] == ',')) ++at;
  }
  return at;
}
}  // namespace

void LogFile::open(const std::string& path) {
  records_.clear();
  skipped_ = 0;
  in_ = std::ifstream(path, std::ios::binary);
  if (std::filesystem::is_directory(path))
    throw Error(fmt::format("The log '{}' is a folder; expected a file of monitor messages.", path));
  if (!in_)
    throw Error(
        fmt::format("The log '{}' cannot be read. Check its name; it is looked up in the working folder.", path));

  // Read chunk by chunk and index each line; a line may span chunks.
  std::string line, chunk(1u << 16, ' ');
  std::uint64_t start = 0, at = 0;  // offsets: of the current line, of the byte to read next
  bool tooLong = false;
  const auto endLine = [&](std::uint64_t end) {
    if (tooLong)
      ++skipped_;
    else
      addLine(start, line);
    line.clear();
    tooLong = false;
    start = end + 1;
  };
  while (in_.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), in_.gcount() > 0) {
    std::string_view rest(chunk.data(), static_cast<std::size_t>(in_.gcount()));
    while (!rest.empty()) {
      const std::size_t end = rest.find('\n');
      const std::string_view piece = rest.substr(0, end);
      tooLong |= line.size() + piece.size() > kMaxLineBytes;
      if (!tooLong) line.append(piece);
      at += piece.size();
      if (end == std::string_view::npos) break;
      endLine(at++);
      rest.remove_prefix(end + 1);
    }
  }
  if (at > start) endLine(at);  // the last line may have no newline
  in_.clear();
  if (records_.empty())
    throw Error(fmt::format(
        "The log '{}' holds no record; expected lines like ((time 0)...)(RSG 0 1)(...), or the same in JSON.", path));
}

void LogFile::addLine(std::uint64_t offset, std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  const std::size_t skip = isJson(line) ? 0 : drawCommandBytes(line);
  line.remove_prefix(skip);
  if (line.empty() && skip == 0) return;
  if (line.empty() || (line.front() != '(' && !isJson(line)) || records_.size() >= kMaxRecords) {
    ++skipped_;
    return;
  }
  const bool isFull = line.find(isJson(line) ? "],[\"RSG\"," : ")(RSG ") != std::string_view::npos;
  const auto full = isFull ? static_cast<std::uint32_t>(records_.size()) : records_.empty() ? 0 : records_.back().full;
  records_.push_back({offset + skip, static_cast<std::uint32_t>(line.size()), static_cast<std::uint32_t>(skip), full});
}

const std::string& LogFile::read(std::uint64_t offset, std::size_t size) {
  line_.resize(size);
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(offset));
  if (!in_.read(line_.data(), static_cast<std::streamsize>(size))) line_.clear();
  return line_;
}

const std::string& LogFile::read(std::size_t i) { return read(records_.at(i).offset, records_.at(i).size); }

const std::string& LogFile::readDrawings(std::size_t i) {
  return read(records_.at(i).offset - records_.at(i).drawn, records_.at(i).drawn);
}

}  // namespace spark
