#pragma once
/// \file
/// The log of one kernel. Writes to stderr unless a sink is set, and to further sinks. Thread safe.

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/log.h"

namespace spark {

/// How important a message is. `off` is a threshold that no message reaches.
enum class Level { trace, debug, info, warning, error, off };

/// The level of that name: "trace", "debug", "info", "warning", "error" or "off". Throws Error for any other word.
Level levelFromName(std::string_view name);
/// The names of all levels, in their order.
const std::vector<std::string>& levelNames();
/// The name of a level.
const std::string& nameOf(Level level);
/// At most `bytes` of a text of UTF-8, in whole characters, with a mark that says how much was cut; a text that is no
/// longer as it is.
std::string shortened(std::string_view text, std::size_t bytes);

/// A kernel's log. A message below the level costs one comparison.
class Log {
 public:
  /// Receives each message that passes the level. Calls are serialised, and may come from any thread.
  using Sink = std::function<void(Level, std::string_view)>;
  /// A log at level `info` that writes to stderr.
  Log();
  ~Log();
  /// Drops messages below `level` from now on, on stderr or the sink in its place.
  void setLevel(Level level);
  /// The lowest level that is written to stderr or the sink in its place.
  Level level() const { return level_; }
  /// True if messages of that level are written anywhere.
  bool enabled(Level level) const { return level >= lowest_; }
  /// Sends every message that passes the level to `sink` instead of stderr. An empty sink restores stderr.
  void setSink(Sink sink);
  /// Sends messages of at least `level` to a further sink, which must not block. Returns a number for the calls below.
  int addSink(Level level, Sink sink);
  /// Changes the level of a further sink. Ignores unknown numbers.
  void setLevel(int sink, Level level);
  /// Removes a further sink. It is not called after this function has returned. Ignores unknown numbers.
  void removeSink(int sink);

  /// Writes a message at level `trace`, formatted by fmt::format only if the level is enabled.
  template <class... A>
  void trace(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::trace)) write(Level::trace, fmt::format(f, std::forward<A>(a)...));
  }
  /// As trace(), at level `debug`.
  template <class... A>
  void debug(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::debug)) write(Level::debug, fmt::format(f, std::forward<A>(a)...));
  }
  /// As trace(), at level `info`.
  template <class... A>
  void info(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::info)) write(Level::info, fmt::format(f, std::forward<A>(a)...));
  }
  /// As trace(), at level `warning`.
  template <class... A>
  void warning(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::warning)) write(Level::warning, fmt::format(f, std::forward<A>(a)...));
  }
  /// Writes a message at level `error`, and counts it whatever the level is.
  template <class... A>
  void error(fmt::format_string<A...> f, A&&... a) {
    write(Level::error, fmt::format(f, std::forward<A>(a)...));
  }
  /// Writes one message. Lines after the first are indented and control characters are escaped as \xNN, because the
  /// text may come from a client.
  void write(Level level, std::string_view line);
  /// The number of messages of level `error` so far, including those below the level. Not part of the state.
  std::int64_t errors() const { return errors_.load(std::memory_order_relaxed); }

 private:
  struct Impl;
  void updateLowest();
  std::unique_ptr<Impl> impl_;
  std::atomic<Level> level_{Level::info};   ///< of stderr
  std::atomic<Level> lowest_{Level::info};  ///< of stderr and all sinks
  std::atomic<std::int64_t> errors_{0};
};

}  // namespace spark
