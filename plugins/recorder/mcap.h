#pragma once
/// \file
/// MCAP, the container of recordings: https://mcap.dev/spec. A writer and a reader of files with zstd chunks.

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spark::mcap {

/// Time of a message [ns], from the start of the recording.
using Time = std::int64_t;

/// CRC-32 (IEEE) of bytes; `seed`: the CRC of what came before them.
std::uint32_t crc32(std::string_view bytes, std::uint32_t seed = 0);

struct Schema {
  std::string name, encoding, data;
};
struct Channel {
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic, encoding;
};

/// Writes a file. Schemas and channels stand at its front and again in its summary, messages in chunks, each of which
/// can be read without the others. One thread at a time.
class Writer {
 public:
  /// Takes bytes, in order. It may throw; what the writer was asked for is then not in the file.
  using Sink = std::function<void(std::string_view)>;
  /// Writes the header. `library`: name of the writing program.
  Writer(Sink sink, std::string_view library);
  /// Adds a schema; its number, from 1.
  std::uint16_t schema(const Schema& schema);
  /// Adds a channel; its number, from 1.
  std::uint16_t channel(const Channel& channel);
  /// Adds a message to the chunk. Times of a channel must not fall.
  void message(std::uint16_t channel, Time time, std::string_view data);
  /// Writes a file into the recording.
  void attachment(Time time, std::string_view name, std::string_view mediaType, std::string_view data);
  void metadata(std::string_view name, const std::map<std::string, std::string>& values);
  /// Bytes and time in the present chunk.
  std::size_t chunkBytes() const { return chunk_.size(); }
  Time chunkBegin() const { return chunkBegin_; }
  /// Compresses and writes the present chunk, if there is something in it.
  void endChunk();
  /// Writes the summary and the end. Nothing may follow.
  void finish();

 private:
  struct ChunkIndex {
    Time begin, end;
    std::uint64_t offset, length;
    std::map<std::uint16_t, std::uint64_t> indexes;  ///< offset of each channel's message index
    std::uint64_t indexLength, compressed, uncompressed;
  };
  struct Index {
    std::uint64_t offset, length;
    std::string content;  ///< what follows offset and length
  };
  void put(std::string_view bytes);
  void record(std::uint8_t op, std::string_view content);
  Sink sink_;
  std::uint64_t at_ = 0;  ///< offset in the file
  std::uint32_t dataCrc_ = 0;
  std::vector<std::string> schemas_, channels_;                                   ///< contents of their records
  std::string chunk_;                                                             ///< records of the present chunk
  std::map<std::uint16_t, std::vector<std::pair<Time, std::uint64_t>>> offsets_;  ///< of its messages
  Time chunkBegin_ = 0, chunkEnd_ = 0;
  std::vector<ChunkIndex> chunks_;
  std::vector<Index> attachments_, metadata_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::map<std::uint16_t, std::uint32_t> sequences_;
  std::uint64_t messages_ = 0;
  Time first_ = 0, last_ = 0;
};

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  Time time = 0;
  std::string_view data;  ///< valid during the call
};

/// Reads a file, also one that was cut off or is damaged in places: what is missing is in lacks(). One thread.
class Reader {
 public:
  /// Reads the structure of the file. Throws Error if it cannot be read, or is no MCAP file at all.
  explicit Reader(const std::string& file);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// What is missing, a sentence each: the end of the file, chunks that are damaged. Chunks are checked as they are
  /// read.
  const std::vector<std::string>& lacks() const { return lacks_; }
  const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  /// The number of the channel with that topic; 0: there is none.
  std::uint16_t channelOf(std::string_view topic) const;
  const std::vector<std::pair<std::string, std::map<std::string, std::string>>>& metadata() const { return metadata_; }
  /// The values of the last metadata of that name; empty if there are none.
  std::map<std::string, std::string> metadataOf(std::string_view name) const;
  struct Attachment {
    std::string name, mediaType;
    Time time = 0;
    std::uint64_t offset = 0, length = 0;  ///< of its bytes
    std::uint32_t crc = 0;
    std::uint64_t recordOffset = 0;
  };
  const std::vector<Attachment>& attachments() const { return attachments_; }
  /// The bytes of one. Throws Error if they are damaged.
  std::string read(const Attachment& attachment) const;
  struct Chunk {
    Time begin = 0, end = 0;
    std::uint64_t offset = 0;  ///< of its record
    std::uint64_t length = 0;  ///< with opcode and length
  };
  /// In the order of the file.
  const std::vector<Chunk>& chunks() const { return chunks_; }
  /// Time of the last chunk's end; 0 if there is none.
  Time end() const { return chunks_.empty() ? 0 : chunks_.back().end; }
  /// Calls `take` with the messages of a chunk in their order, until it returns false. A chunk that is damaged has none
  /// beyond the damage; that is added to lacks(). False if it is damaged, as far as it was read.
  bool forEach(const Chunk& chunk, const std::function<bool(const Message&)>& take);

 private:
  void readFromFront();
  bool readFromEnd();
  std::string bytes(std::uint64_t offset, std::uint64_t length) const;
  void define(std::string_view content);
  void readRepeated(std::uint8_t op, std::string_view content);
  void readSchema(std::string_view content);
  void readChannel(std::string_view content);
  void readMetadata(std::string_view content);
  bool readAttachment(std::uint64_t offset, std::uint64_t length);
  bool readChunkHead(std::uint64_t offset, std::uint64_t length);

  std::string name_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
  std::vector<std::string> lacks_;
  std::size_t definitions_ = 0;  ///< bytes of schemas and channels
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<std::pair<std::string, std::map<std::string, std::string>>> metadata_;
  std::vector<Attachment> attachments_;
  std::vector<Chunk> chunks_;
};

}  // namespace spark::mcap
