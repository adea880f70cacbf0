#include "memory_log_sink.h"

#include <algorithm>

namespace spark {

void MemoryLogSink::describe(Description<MemoryLogSink>& d) {
  d.doc("Keeps the last messages of the log.");
  d.property("capacity", &MemoryLogSink::capacity, &MemoryLogSink::setCapacity)
      .range(1, 100000)
      .doc("Number of messages that it keeps. Setting it forgets all.");
  d.method("tail", &MemoryLogSink::tail)
      .parameters({"count"})
      .optional(1)
      .doc("The last messages, the oldest first; count 0 or none: all that it keeps.");
}

std::shared_ptr<spdlog::logger> MemoryLogSink::open() {
  sink_ = std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(static_cast<std::size_t>(capacity_));
  return std::make_shared<spdlog::logger>("log", sink_);
}

void MemoryLogSink::setCapacity(int messages) {
  capacity_ = messages;
  restart();
}

std::vector<std::string> MemoryLogSink::tail(int count) const {
  if (!sink_) return {};
  std::vector<std::string> lines = sink_->last_formatted(static_cast<std::size_t>(std::max(count, 0)));
  for (std::string& line : lines) line.erase(line.find_last_not_of('\n') + 1);
  return lines;
}

}  // namespace spark
