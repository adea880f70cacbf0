#pragma once
/// \file
/// What receives the log beside stderr.

#include <spdlog/logger.h>

#include <memory>
#include <string>
#include <string_view>

#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/leaf.h"

namespace spark {

/// A receiver of the log's messages, with a level of its own. It works while it is linked, anywhere in the tree.
class LogSink : public Leaf {
  SPARK_CLASS(LogSink, Leaf)
 public:
  static void describe(Description<LogSink>& d);

 protected:
  void onLink() override { restart(); }
  void onUnlink() override { stop(); }
  /// The logger that messages go to; it must not block. nullptr: none, because the settings are incomplete. Throws if
  /// it cannot be made.
  virtual std::shared_ptr<spdlog::logger> open() = 0;
  /// What to do when messages cannot be written; a sentence without its full stop.
  virtual const char* advice() const { return "Remove the sink"; }
  /// The length of a message [bytes] beyond which it is cut.
  virtual std::size_t longest() const { return std::string_view::npos; }
  /// Opens it again with the present settings, if it is linked. Throws Error if that fails; it is closed then.
  void restart();
  /// A logger that passes messages to `sink` in a thread of its own. When the thread is slow, the oldest of `kWaiting`
  /// messages are dropped.
  static std::shared_ptr<spdlog::logger> inThread(spdlog::sink_ptr sink);
  static constexpr std::size_t kWaiting = 4096;  ///< messages

 private:
  const std::string& level() const { return nameOf(level_); }
  void setLevel(const std::string& name);
  void stop();
  Level level_ = Level::info;
  int number_ = 0;  ///< in the log; 0: closed
};

}  // namespace spark
