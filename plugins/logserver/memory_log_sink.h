#pragma once

#include <spdlog/sinks/ringbuffer_sink.h>

#include <vector>

#include "log_sink.h"

namespace spark {

/// Keeps the last messages for tools that connect later. They are read by a method, not by a property: every viewer of
/// the page can read properties, and the log contains the token of the page.
class MemoryLogSink : public LogSink {
  SPARK_CLASS(MemoryLogSink, LogSink)
 public:
  static void describe(Description<MemoryLogSink>& d);

 protected:
  std::shared_ptr<spdlog::logger> open() override;

 private:
  int capacity() const { return capacity_; }
  void setCapacity(int messages);
  std::vector<std::string> tail(int count) const;
  int capacity_ = 200;
  std::shared_ptr<spdlog::sinks::ringbuffer_sink_mt> sink_;
};

}  // namespace spark
