#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "mcap.h"
#include "mcap_format.h"

namespace spark::mcap {

namespace {
// Limits of what a small file may need; beyond them it is damaged.
constexpr std::uint64_t kMaxChunk = 256u << 20;     // bytes
constexpr std::uint64_t kFreeChunk = 16u << 20;     // bytes that a chunk may have, however short it is compressed
constexpr std::uint64_t kMaxRatio = 1000;           // of a larger one's sizes
constexpr std::size_t kMaxDefinitions = 16u << 20;  // bytes of schemas and channels
constexpr std::size_t kFooterSize = kRecordHead + 20;
}  // namespace

Reader::Reader(const std::string& file) : name_(file) {
  fd_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat about = {};
  if (fd_ < 0 || ::fstat(fd_, &about) != 0) {
    const std::string why = std::strerror(errno);
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    throw Error(fmt::format("cannot read {}: {}", file, why));
  }
  try {
    size_ = static_cast<std::uint64_t>(about.st_size);
    if (size_ < kMagic.size() || bytes(0, kMagic.size()) != kMagic)
      throw Error(fmt::format("{} is no recording: expected an MCAP file", file));
    if (!readFromEnd()) {
      schemas_.clear(), channels_.clear(), metadata_.clear(), attachments_.clear(), chunks_.clear();
      definitions_ = 0;
      readFromFront();
    }
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

Reader::~Reader() { ::close(fd_); }

/// Throws Error where the file ends before.
std::string Reader::bytes(std::uint64_t offset, std::uint64_t length) const {
  if (offset > size_ || length > size_ - offset) throw Error(fmt::format("{} ends too early", name_));
  std::string out(length, '\0');
  for (std::size_t done = 0; done < length;) {
    const ssize_t n = ::pread(fd_, out.data() + done, length - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0)
      throw Error(fmt::format("cannot read {}: {}", name_, n < 0 ? std::strerror(errno) : "it ends too early"));
    done += static_cast<std::size_t>(n);
  }
  return out;
}

std::uint16_t Reader::channelOf(std::string_view topic) const {
  for (const auto& [id, c] : channels_)
    if (c.topic == topic) return id;
  return 0;
}

std::map<std::string, std::string> Reader::metadataOf(std::string_view name) const {
  for (auto it = metadata_.rbegin(); it != metadata_.rend(); ++it)
    if (it->first == name) return it->second;
  return {};
}

void Reader::define(std::string_view content) {
  definitions_ += content.size();
  if (definitions_ > kMaxDefinitions)
    throw Error(fmt::format("its schemas and channels have more than {} MB", kMaxDefinitions >> 20));
}

void Reader::readSchema(std::string_view content) {
  FieldsReader f(content);
  const std::uint16_t id = f.u16();
  define(content);
  Schema& s = schemas_[id];
  s.name = f.text(), s.encoding = f.text(), s.data = f.text();
}

void Reader::readChannel(std::string_view content) {
  FieldsReader f(content);
  const std::uint16_t id = f.u16();
  define(content);
  Channel& c = channels_[id];
  c.schema = f.u16(), c.topic = f.text(), c.encoding = f.text();
}

/// Reads a definition in a chunk, where the known ones may be repeated each time the chunk is read.
void Reader::readRepeated(std::uint8_t op, std::string_view content) {
  const std::uint16_t id = FieldsReader(content).u16();
  if (op == kSchema ? schemas_.contains(id) : channels_.contains(id)) return;
  op == kSchema ? readSchema(content) : readChannel(content);
}

void Reader::readMetadata(std::string_view content) {
  FieldsReader f(content);
  std::string name(f.text());
  metadata_.emplace_back(std::move(name), f.texts());
}

/// `offset`, `length`: of the content of its record. False if that is damaged.
bool Reader::readAttachment(std::uint64_t offset, std::uint64_t length) {
  constexpr std::uint64_t kHead = 64 << 10;  // names are shorter
  const std::string head = bytes(offset, std::min(length, kHead));
  FieldsReader f(head);
  Attachment a;
  a.time = f.time();
  f.time();
  a.name = f.text(), a.mediaType = f.text();
  a.length = f.u64();
  a.recordOffset = offset;
  a.offset = offset + (head.size() - f.left().size());
  if (a.length > length - (a.offset - offset) || length - (a.offset - offset) - a.length < 4) return false;
  const std::string crc = bytes(a.offset + a.length, 4);
  a.crc = FieldsReader(crc).u32();
  attachments_.push_back(std::move(a));
  return true;
}

std::string Reader::read(const Attachment& a) const {
  std::string all = bytes(a.recordOffset, a.offset - a.recordOffset + a.length);
  if (a.crc != 0 && crc32(all) != a.crc) throw Error(fmt::format("{}: the file '{}' in it is damaged", name_, a.name));
  return all.substr(a.offset - a.recordOffset);
}

/// The times of a chunk. `offset`, `length`: of its record.
bool Reader::readChunkHead(std::uint64_t offset, std::uint64_t length) {
  if (length < kRecordHead + 40) return false;
  const std::string head = bytes(offset + kRecordHead, 16);
  FieldsReader f(head);
  Chunk c;
  c.begin = f.time(), c.end = f.time();
  c.offset = offset, c.length = length;
  if (c.end < c.begin) return false;
  chunks_.push_back(c);
  return true;
}

/// Reads by the summary at the end. False if there is none, or if it is damaged.
bool Reader::readFromEnd() {
  if (size_ < 2 * kMagic.size() + kFooterSize) return false;
  const std::uint64_t footerAt = size_ - kMagic.size() - kFooterSize;
  const std::string end = bytes(footerAt, kFooterSize + kMagic.size());
  if (std::string_view(end).substr(kFooterSize) != kMagic || end[0] != kFooter) return false;
  try {
    FieldsReader footer(std::string_view(end).substr(kRecordHead));
    const std::uint64_t start = footer.u64();
    footer.u64();
    const std::uint32_t crc = footer.u32();
    if (start == 0 || start > footerAt) return false;
    const std::string summary = bytes(start, footerAt - start);
    if (crc != 0 && crc32(std::string_view(end).substr(0, kFooterSize - 4), crc32(summary)) != crc) return false;
    // What is listed has its own place in the file: nothing is listed twice.
    std::uint64_t left = size_;
    const auto mayBeHere = [&](std::uint64_t at, std::uint64_t length) {
      if (at > size_ || length > size_ - at || length > left) return false;
      left -= length;
      return true;
    };
    for (FieldsReader f(summary); !f.left().empty();) {
      const auto op = f.number<std::uint8_t>();
      const std::string_view content = f.raw(f.u64());
      FieldsReader c(content);
      if (op == kSchema) readSchema(content);
      if (op == kChannel) readChannel(content);
      if (op == kAttachmentIndex || op == kMetadataIndex) {
        const std::uint64_t at = c.u64(), length = c.u64();
        if (length < kRecordHead || !mayBeHere(at, length)) return false;
        if (op == kMetadataIndex)
          readMetadata(bytes(at + kRecordHead, length - kRecordHead));
        else if (!readAttachment(at + kRecordHead, length - kRecordHead))
          return false;
      }
      if (op == kChunkIndex) {
        Chunk chunk;
        chunk.begin = c.time(), chunk.end = c.time();
        chunk.offset = c.u64(), chunk.length = c.u64();
        if (!mayBeHere(chunk.offset, chunk.length)) return false;
        chunks_.push_back(chunk);
      }
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Reads record by record, up to the last whole one.
void Reader::readFromFront() {
  std::uint64_t at = kMagic.size();
  std::string why = "the recording was cut off: it has no end";
  try {
    while (at + kRecordHead <= size_) {
      const std::string head = bytes(at, kRecordHead);
      FieldsReader f(head);
      const auto op = f.number<std::uint8_t>();
      const std::uint64_t length = f.u64();
      if (op == 0 || length > size_ - at - kRecordHead) break;
      const std::uint64_t content = at + kRecordHead;
      if (op == kDataEnd) {
        why = "the end of the recording is damaged";
        break;
      }
      if (op == kSchema) readSchema(bytes(content, length));
      if (op == kChannel) readChannel(bytes(content, length));
      if (op == kMetadata) readMetadata(bytes(content, length));
      if (op == kAttachment && !readAttachment(content, length)) break;
      if (op == kChunk && !readChunkHead(at, kRecordHead + length)) break;
      at = content + length;
    }
  } catch (const Error&) {
    why = "a record is damaged, and all after it is lost";
  }
  lacks_.push_back(
      fmt::format("{}; {} of {} bytes could be read{}", why, at, size_,
                  chunks_.empty() ? "" : fmt::format(", up to {:.3f} s", static_cast<double>(end()) * 1e-9)));
}

bool Reader::forEach(const Chunk& chunk, const std::function<bool(const Message&)>& take) {
  bool more = true;
  try {
    const std::string record = bytes(chunk.offset, chunk.length);
    if (record.size() < kRecordHead || record[0] != kChunk) throw Error("there is no chunk");
    FieldsReader f(std::string_view(record).substr(kRecordHead));
    f.time(), f.time();
    const std::uint64_t size = f.u64();
    const std::uint32_t crc = f.u32();
    const std::string_view compression = f.text(), stored = f.raw(f.u64());
    if (size > kMaxChunk || (size > kFreeChunk && size / kMaxRatio > stored.size()))
      throw Error("its size is too large");
    std::string records;
    if (compression == "zstd") {
      records.resize(size);
      const std::size_t n = ZSTD_decompress(records.data(), records.size(), stored.data(), stored.size());
      if (ZSTD_isError(n) || n != size) throw Error("it cannot be decompressed");
    } else if (compression.empty()) {
      records = stored;
    } else {
      throw Error(fmt::format("its compression is '{}', expected zstd or none", compression));
    }
    if (crc != 0 && crc32(records) != crc) throw Error("its sum is wrong");
    for (FieldsReader r(records); more && !r.left().empty();) {
      const auto op = r.number<std::uint8_t>();
      const std::string_view content = r.raw(r.u64());
      if (op == kSchema || op == kChannel) readRepeated(op, content);
      if (op != kMessage) continue;
      FieldsReader m(content);
      Message message;
      message.channel = m.u16(), message.sequence = m.u32(), message.time = m.time();
      m.time();
      message.data = m.left();
      more = take(message);
    }
  } catch (const Error& e) {
    const std::string line =
        fmt::format("the chunk from {:.3f} to {:.3f} s is damaged: {}", static_cast<double>(chunk.begin) * 1e-9,
                    static_cast<double>(chunk.end) * 1e-9, e.what());
    if (std::find(lacks_.begin(), lacks_.end(), line) == lacks_.end()) lacks_.push_back(line);
    return false;
  }
  return true;
}

}  // namespace spark::mcap
