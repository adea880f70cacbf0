#pragma once
/// \file
/// A question to the simulation thread that another thread waits for: where is this file?

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

namespace spark::web {

/// The host's file of a resource, or its content if it is in an archive. Neither: it does not exist.
struct FoundFile {
  std::optional<std::filesystem::path> path;
  std::optional<std::string> content;
};

/// Any thread.
class FileQuestion {
 public:
  /// Answers it; only the first answer counts.
  void answer(FoundFile found) {
    const std::lock_guard lock(mutex_);
    if (!answer_) answer_ = std::move(found);
    answered_.notify_all();
  }
  /// Waits for the answer and takes it, once.
  FoundFile wait() {
    std::unique_lock lock(mutex_);
    answered_.wait(lock, [this] { return answer_.has_value(); });
    return *std::move(answer_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable answered_;
  std::optional<FoundFile> answer_;
};

}  // namespace spark::web
