#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <array>

#include "mcap.h"
#include "mcap_format.h"

namespace spark::mcap {

std::uint32_t crc32(std::string_view bytes, std::uint32_t seed) {
  // Four bytes at a time: table[k][b] is the CRC of byte b with k zero bytes behind it.
  static const auto tables = [] {
    std::array<std::array<std::uint32_t, 256>, 4> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int bit = 0; bit < 8; ++bit) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      t[0][i] = c;
    }
    for (std::size_t k = 1; k < 4; ++k)
      for (std::size_t i = 0; i < 256; ++i) t[k][i] = t[k - 1][i] >> 8 ^ t[0][t[k - 1][i] & 0xff];
    return t;
  }();
  std::uint32_t c = ~seed;
  const auto* p = reinterpret_cast<const unsigned char*>(bytes.data());
  std::size_t n = bytes.size();
  for (; n >= 4; n -= 4, p += 4) {
    c ^= static_cast<std::uint32_t>(p[0]) | static_cast<std::uint32_t>(p[1]) << 8 |
         static_cast<std::uint32_t>(p[2]) << 16 | static_cast<std::uint32_t>(p[3]) << 24;
    c = tables[3][c & 0xff] ^ tables[2][c >> 8 & 0xff] ^ tables[1][c >> 16 & 0xff] ^ tables[0][c >> 24];
  }
  for (; n > 0; --n, ++p) c = tables[0][(c ^ *p) & 0xff] ^ (c >> 8);
  return ~c;
}

namespace {
std::string recordOf(Op op, std::string_view content) {
  Fields f;
  f.number(static_cast<std::uint8_t>(op)).u64(content.size()).raw(content);
  return std::move(f.bytes);
}
}  // namespace

Writer::Writer(Sink sink, std::string_view library) : sink_(std::move(sink)) {
  put(kMagic);
  record(kHeader, Fields().text("").text(library).bytes);
}

/// Writes to the file; all of it is in the CRC of the data section.
void Writer::put(std::string_view bytes) {
  sink_(bytes);
  at_ += bytes.size();
  dataCrc_ = crc32(bytes, dataCrc_);
}

void Writer::record(std::uint8_t op, std::string_view content) { put(recordOf(static_cast<Op>(op), content)); }

std::uint16_t Writer::schema(const Schema& s) {
  const std::size_t id = schemas_.size() + 1;
  schemas_.push_back(Fields().u16(id).text(s.name).text(s.encoding).text(s.data).bytes);
  record(kSchema, schemas_.back());
  return static_cast<std::uint16_t>(id);
}

std::uint16_t Writer::channel(const Channel& c) {
  const std::size_t id = channels_.size() + 1;
  channels_.push_back(Fields().u16(id).u16(c.schema).text(c.topic).text(c.encoding).texts({}).bytes);
  record(kChannel, channels_.back());
  return static_cast<std::uint16_t>(id);
}

void Writer::message(std::uint16_t channel, Time time, std::string_view data) {
  if (chunk_.empty()) chunkBegin_ = chunkEnd_ = time;
  chunkBegin_ = std::min(chunkBegin_, time);
  chunkEnd_ = std::max(chunkEnd_, time);
  offsets_[channel].emplace_back(time, chunk_.size());
  chunk_ += recordOf(kMessage, Fields().u16(channel).u32(sequences_[channel]++).time(time).time(time).raw(data).bytes);
}

/// Of compression: higher levels take much more time for few percent.
constexpr int kLevel = 9;

void Writer::endChunk() {
  if (chunk_.empty()) return;
  std::string compressed(ZSTD_compressBound(chunk_.size()), '\0');
  const std::size_t size = ZSTD_compress(compressed.data(), compressed.size(), chunk_.data(), chunk_.size(), kLevel);
  if (ZSTD_isError(size)) throw Error(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  compressed.resize(size);
  ChunkIndex index{chunkBegin_, chunkEnd_, at_, 0, {}, 0, size, chunk_.size()};
  const std::string chunk = recordOf(kChunk, Fields()
                                                 .time(chunkBegin_)
                                                 .time(chunkEnd_)
                                                 .u64(chunk_.size())
                                                 .u32(crc32(chunk_))
                                                 .text("zstd")
                                                 .u64(size)
                                                 .raw(compressed)
                                                 .bytes);
  index.length = chunk.size();
  // The chunk and its indexes in one piece, so that a file that is cut off has both or none.
  std::string all = chunk;
  for (const auto& [channel, offsets] : offsets_) {
    Fields entries;
    for (const auto& [time, offset] : offsets) entries.time(time).u64(offset);
    index.indexes[channel] = at_ + all.size();
    all += recordOf(kMessageIndex, Fields().u16(channel).text(entries.bytes).bytes);
  }
  index.indexLength = all.size() - chunk.size();
  put(all);
  for (const auto& [channel, offsets] : offsets_) counts_[channel] += offsets.size(), messages_ += offsets.size();
  first_ = chunks_.empty() ? chunkBegin_ : std::min(first_, chunkBegin_);
  last_ = std::max(last_, chunkEnd_);
  chunks_.push_back(std::move(index));
  chunk_.clear();
  offsets_.clear();
}

void Writer::attachment(Time time, std::string_view name, std::string_view mediaType, std::string_view data) {
  Fields f;
  f.time(time).time(time).text(name).text(mediaType).u64(data.size()).raw(data);
  f.u32(crc32(f.bytes));
  const std::uint64_t offset = at_;
  record(kAttachment, f.bytes);
  attachments_.push_back(
      {offset, at_ - offset, Fields().time(time).time(time).u64(data.size()).text(name).text(mediaType).bytes});
}

void Writer::metadata(std::string_view name, const std::map<std::string, std::string>& values) {
  const std::uint64_t offset = at_;
  record(kMetadata, Fields().text(name).texts(values).bytes);
  metadata_.push_back({offset, at_ - offset, Fields().text(name).bytes});
}

void Writer::finish() {
  endChunk();
  record(kDataEnd, Fields().u32(dataCrc_).bytes);
  const std::uint64_t start = at_;
  std::string summary, offsets;
  const auto group = [&](Op op, const std::vector<std::string>& contents) {
    if (contents.empty()) return;
    const std::uint64_t begin = start + summary.size();
    for (const std::string& c : contents) summary += recordOf(op, c);
    offsets +=
        recordOf(kSummaryOffset,
                 Fields().number(static_cast<std::uint8_t>(op)).u64(begin).u64(start + summary.size() - begin).bytes);
  };
  const auto indexes = [](const std::vector<Index>& all) {
    std::vector<std::string> out;
    out.reserve(all.size());
    for (const Index& i : all) out.push_back(Fields().u64(i.offset).u64(i.length).raw(i.content).bytes);
    return out;
  };
  group(kSchema, schemas_);
  group(kChannel, channels_);
  Fields counts;
  for (const auto& [channel, n] : counts_) counts.u16(channel).u64(n);
  group(kStatistics, {Fields()
                          .u64(messages_)
                          .u16(schemas_.size())
                          .u32(channels_.size())
                          .u32(attachments_.size())
                          .u32(metadata_.size())
                          .u32(chunks_.size())
                          .time(first_)
                          .time(last_)
                          .text(counts.bytes)
                          .bytes});
  std::vector<std::string> chunks;
  for (const ChunkIndex& c : chunks_) {
    Fields places;
    for (const auto& [channel, offset] : c.indexes) places.u16(channel).u64(offset);
    chunks.push_back(Fields()
                         .time(c.begin)
                         .time(c.end)
                         .u64(c.offset)
                         .u64(c.length)
                         .text(places.bytes)
                         .u64(c.indexLength)
                         .text("zstd")
                         .u64(c.compressed)
                         .u64(c.uncompressed)
                         .bytes);
  }
  group(kChunkIndex, chunks);
  group(kAttachmentIndex, indexes(attachments_));
  group(kMetadataIndex, indexes(metadata_));
  const std::uint64_t offsetStart = start + summary.size();
  // The CRC of the summary covers the footer up to itself.
  std::string end = summary + offsets;
  Fields footer;
  footer.number(static_cast<std::uint8_t>(kFooter)).u64(8 + 8 + 4).u64(start).u64(offsetStart);
  end += footer.bytes;
  end += Fields().u32(crc32(end)).bytes;
  put(end);
  put(kMagic);
}

}  // namespace spark::mcap
