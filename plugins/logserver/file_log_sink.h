#pragma once

#include "log_sink.h"

namespace spark {

/// Writes the log to a file. When the file is full it is renamed to NAME.1.EXT, and so on, and a new one begins.
class FileLogSink : public LogSink {
  SPARK_CLASS(FileLogSink, LogSink)
 public:
  static void describe(Description<FileLogSink>& d);

 protected:
  std::shared_ptr<spdlog::logger> open() override;
  const char* advice() const override { return "Make room on the disk, or set file to another one"; }

 private:
  const std::string& file() const { return file_; }
  void setFile(std::string file);
  std::int64_t maxSize() const { return maxSize_; }
  void setMaxSize(std::int64_t bytes);
  int older() const { return older_; }
  void setOlder(int files);
  std::string file_;
  std::int64_t maxSize_ = 10 << 20;
  int older_ = 3;
};

}  // namespace spark
