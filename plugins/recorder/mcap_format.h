#pragma once
/// \file
/// Private to mcap_writer.cpp and mcap_reader.cpp: records and their fields.

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "spark/error.h"

namespace spark::mcap {

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
inline constexpr std::size_t kRecordHead = 1 + 8;  ///< opcode and length

enum Op : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd
};

/// Fields as bytes, little endian.
struct Fields {
  std::string bytes;
  template <class T>
  Fields& number(T v) {
    static_assert(std::is_unsigned_v<T>);
    for (std::size_t i = 0; i < sizeof v; ++i) bytes += static_cast<char>(v >> (8 * i));
    return *this;
  }
  Fields& u16(std::uint64_t v) { return number(static_cast<std::uint16_t>(v)); }
  Fields& u32(std::uint64_t v) { return number(static_cast<std::uint32_t>(v)); }
  Fields& u64(std::uint64_t v) { return number(v); }
  Fields& time(std::int64_t v) { return number(static_cast<std::uint64_t>(v)); }
  Fields& raw(std::string_view v) { return bytes += v, *this; }
  Fields& text(std::string_view v) { return u32(v.size()).raw(v); }
  Fields& texts(const std::map<std::string, std::string>& map) {
    Fields inner;
    for (const auto& [key, value] : map) inner.text(key).text(value);
    return text(inner.bytes);
  }
};

/// Takes fields from bytes. Throws Error where they end early.
class FieldsReader {
 public:
  explicit FieldsReader(std::string_view bytes) : left_(bytes) {}
  template <class T>
  T number() {
    const std::string_view b = raw(sizeof(T));
    T out = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      out |= static_cast<T>(static_cast<T>(static_cast<unsigned char>(b[i])) << (8 * i));
    return out;
  }
  std::uint16_t u16() { return number<std::uint16_t>(); }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  std::int64_t time() { return static_cast<std::int64_t>(u64()); }
  std::string_view raw(std::uint64_t n) {
    if (n > left_.size()) throw Error("a record is shorter than its fields");
    const std::string_view out = left_.substr(0, n);
    left_.remove_prefix(n);
    return out;
  }
  std::string_view text() { return raw(u32()); }
  std::map<std::string, std::string> texts() {
    FieldsReader inner(text());
    std::map<std::string, std::string> out;
    while (!inner.left().empty()) {
      std::string key(inner.text());
      out[std::move(key)] = std::string(inner.text());
    }
    return out;
  }
  std::string_view left() const { return left_; }

 private:
  std::string_view left_;
};

}  // namespace spark::mcap
