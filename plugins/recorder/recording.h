#pragma once
/// \file
/// A recording that is being written, by a thread of its own.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "mcap.h"
#include "spark/output_file.h"

namespace spark::recorder {

/// Writes an MCAP file. The functions only queue, so that no simulation waits for a disk; if the disk cannot follow, or
/// is full, the recording ends, and failure() says so. One thread calls them.
class Recording {
 public:
  /// Opens the file. `maxQueued`: bytes that may wait to be written. Throws Error if it cannot be written.
  Recording(const std::string& file, std::string library, std::size_t maxQueued = 256u << 20);
  /// As end().
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Adds a channel; its number. Before the first message.
  std::uint16_t channel(mcap::Channel channel, mcap::Schema schema = {});
  void message(std::uint16_t channel, mcap::Time time, std::string data);
  /// Adds a message, in the thread that writes.
  using Put = std::function<void(std::uint16_t channel, mcap::Time time, std::string_view data)>;
  /// Calls `encode` in the thread that writes, after all that was queued before. It adds messages. `bytes`: memory that
  /// it needs until then.
  void later(std::size_t bytes, std::function<void(const Put& put)> encode);
  void attachment(mcap::Time time, std::string name, std::string mediaType, std::string data);
  void metadata(std::string name, std::map<std::string, std::string> values);
  /// Writes what is queued, and the end, unless it has failed: readers then say that the end is missing. A pipe whose
  /// reader takes nothing for some seconds costs the recording its end. Nothing may follow; returns failure().
  std::string end();
  /// Removes the file again, if it was made here: there was no run to record.
  void discard();
  /// Waits until all so far is in the file, or the recording has failed.
  void flush();
  /// Why the recording has ended; "" while it goes on.
  std::string failure() const;

 private:
  struct Item {
    enum class Kind { channel, message, attachment, metadata, encode, flush } kind;
    std::uint16_t number = 0;
    mcap::Time time = 0;
    std::string name, type, data;
    mcap::Schema schema;
    std::map<std::string, std::string> values;
    std::function<void(const Put& put)> encode;
    std::size_t extra = 0;
    std::size_t bytes() const {
      return sizeof *this + extra + name.size() + type.size() + data.size() + schema.data.size();
    }
  };
  void queue(Item item);
  void work();
  void write(mcap::Writer& writer, const Item& item);
  static void add(mcap::Writer& writer, std::uint16_t channel, mcap::Time time, std::string_view data);
  void put(std::string_view bytes);

  std::string library_;
  OutputFile out_;
  std::chrono::steady_clock::time_point moved_;  ///< when the file took bytes last; thread of the recording
  std::uint16_t channels_ = 0, schemas_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable wake_, flushed_;
  int toFlush_ = 0;  ///< calls of flush() that wait
  std::vector<Item> items_;
  const std::size_t maxQueued_;
  std::size_t queued_ = 0;  ///< bytes
  bool ending_ = false;
  std::string failure_;
  std::thread thread_;
};

}  // namespace spark::recorder
