#include "recording.h"

#include <fmt/format.h>

#include "spark/error.h"

namespace spark::recorder {

namespace {
constexpr std::size_t kChunkBytes = 4u << 20;
// A chunk of its own, so that a page need not decompress states when it shows what is beside them.
constexpr std::size_t kLargeMessage = 512u << 10;
constexpr mcap::Time kChunkTime = 1'000'000'000;             // ns
constexpr auto kChunkWall = std::chrono::milliseconds(500);  // of real time
// The thread looks by itself for what is queued, since waking it for each message would cost the simulation more than
// all else: at this interval, and at once only for this many bytes.
constexpr auto kLook = kChunkWall / 4;
constexpr std::size_t kWakeBytes = 1u << 20;
// How long the end of a recording waits for a pipe that takes nothing.
constexpr auto kPatience = std::chrono::seconds(4);
}  // namespace

Recording::Recording(const std::string& file, std::string library, std::size_t maxQueued)
    : library_(std::move(library)), out_(file, "the recording"), maxQueued_(maxQueued) {
  thread_ = std::thread([this] { work(); });
}

Recording::~Recording() { end(); }

std::string Recording::end() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  return failure_;
}

void Recording::discard() {
  end();
  out_.discard();
}

std::string Recording::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

std::uint16_t Recording::channel(mcap::Channel channel, mcap::Schema schema) {
  Item item{Item::Kind::channel};
  if (!schema.name.empty()) item.number = ++schemas_;
  item.name = std::move(channel.topic), item.type = std::move(channel.encoding);
  item.schema = std::move(schema);
  queue(std::move(item));
  return ++channels_;
}

void Recording::message(std::uint16_t channel, mcap::Time time, std::string data) {
  Item item{Item::Kind::message};
  item.number = channel, item.time = time, item.data = std::move(data);
  queue(std::move(item));
}

void Recording::later(std::size_t bytes, std::function<void(const Put& put)> encode) {
  Item item{Item::Kind::encode};
  item.extra = bytes, item.encode = std::move(encode);
  queue(std::move(item));
}

void Recording::attachment(mcap::Time time, std::string name, std::string mediaType, std::string data) {
  Item item{Item::Kind::attachment};
  item.time = time, item.name = std::move(name), item.type = std::move(mediaType), item.data = std::move(data);
  queue(std::move(item));
}

void Recording::metadata(std::string name, std::map<std::string, std::string> values) {
  Item item{Item::Kind::metadata};
  item.name = std::move(name), item.values = std::move(values);
  queue(std::move(item));
}

void Recording::flush() {
  {
    const std::lock_guard lock(mutex_);
    ++toFlush_;
  }
  queue(Item{Item::Kind::flush});
  std::unique_lock lock(mutex_);
  flushed_.wait(lock, [this] { return toFlush_ == 0 || !failure_.empty(); });
}

void Recording::queue(Item item) {
  bool urgent = item.kind == Item::Kind::flush;
  {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) return;
    const bool before = queued_ >= kWakeBytes;
    queued_ += item.bytes();
    urgent |= queued_ >= kWakeBytes && !before;
    if (queued_ > maxQueued_) {
      failure_ = fmt::format("more than {} MB wait to be written", maxQueued_ >> 20);
      return;
    }
    items_.push_back(std::move(item));
  }
  if (urgent) wake_.notify_one();
}

void Recording::put(std::string_view bytes) {
  using Clock = std::chrono::steady_clock;
  moved_ = Clock::now();
  out_.write(bytes, [this] {
    const std::lock_guard lock(mutex_);
    return (ending_ || toFlush_ > 0) && Clock::now() - moved_ > kPatience;
  });
}

void Recording::add(mcap::Writer& writer, std::uint16_t channel, mcap::Time time, std::string_view data) {
  const bool large = data.size() >= kLargeMessage;
  if (large || (writer.chunkBytes() > 0 && time - writer.chunkBegin() >= kChunkTime)) writer.endChunk();
  writer.message(channel, time, data);
  if (large || writer.chunkBytes() >= kChunkBytes) writer.endChunk();
}

void Recording::write(mcap::Writer& writer, const Item& item) {
  switch (item.kind) {
    case Item::Kind::channel: {
      if (!item.schema.name.empty()) writer.schema(item.schema);
      writer.channel({item.number, item.name, item.type});
      return;
    }
    case Item::Kind::message:
      return add(writer, item.number, item.time, item.data);
    case Item::Kind::encode:
      return item.encode([&writer](auto... message) { add(writer, message...); });
    case Item::Kind::attachment:
      return writer.attachment(item.time, item.name, item.type, item.data);
    case Item::Kind::metadata:
      return writer.metadata(item.name, item.values);
    case Item::Kind::flush: {
      writer.endChunk();
      const std::lock_guard lock(mutex_);
      --toFlush_;
      return flushed_.notify_all();
    }
  }
}

void Recording::work() {
  using Clock = std::chrono::steady_clock;
  try {
    mcap::Writer writer([this](std::string_view bytes) { put(bytes); }, library_);
    std::vector<Item> items;
    for (auto began = Clock::now();;) {
      bool ending = false;
      {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, kLook, [this] { return ending_ || toFlush_ > 0 || queued_ >= kWakeBytes; });
        items.swap(items_);
        queued_ = 0;
        ending = ending_;
      }
      if (writer.chunkBytes() == 0) began = Clock::now();
      for (const Item& item : items) write(writer, item);
      items.clear();
      if (Clock::now() - began >= kChunkWall) writer.endChunk();
      if (!ending) continue;
      const std::lock_guard lock(mutex_);
      if (!items_.empty()) continue;
      if (failure_.empty())
        writer.finish();
      else
        writer.endChunk();
      return;
    }
  } catch (const std::exception& e) {
    const std::lock_guard lock(mutex_);
    failure_ = e.what();
    items_.clear();
    flushed_.notify_all();
  }
}

}  // namespace spark::recorder
