#pragma once
/// \file
/// The log of one kernel: levels, one line a message, on stderr unless a sink is set. Thread safe.

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "spark/abi/spark/log.h"

namespace spark {

enum class Level { trace, debug, info, warning, error, off };

/// "trace" ... "off"; throws Error for other words.
Level levelFromName(std::string_view name);

/// A kernel's log. Writing below the level costs one comparison.
class Log {
 public:
  using Sink = std::function<void(Level, std::string_view)>;
  Log();
  ~Log();
  void setLevel(Level level) { level_ = level; }
  Level level() const { return level_; }
  bool enabled(Level level) const { return level >= level_; }
  /// Sends every line that passes the level to `sink` instead of stderr; an empty sink restores stderr.
  void setSink(Sink sink);

  template <class... A>
  void trace(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::trace)) write(Level::trace, fmt::format(f, std::forward<A>(a)...));
  }
  template <class... A>
  void debug(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::debug)) write(Level::debug, fmt::format(f, std::forward<A>(a)...));
  }
  template <class... A>
  void info(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::info)) write(Level::info, fmt::format(f, std::forward<A>(a)...));
  }
  template <class... A>
  void warning(fmt::format_string<A...> f, A&&... a) {
    if (enabled(Level::warning)) write(Level::warning, fmt::format(f, std::forward<A>(a)...));
  }
  template <class... A>
  void error(fmt::format_string<A...> f, A&&... a) {
    write(Level::error, fmt::format(f, std::forward<A>(a)...));
  }
  /// One line, or several of which all but the first are indented (control characters are escaped: the text may come
  /// from a client).
  void write(Level level, std::string_view line);
  /// Errors so far, whether the level lets them pass or not. No state.
  std::int64_t errors() const { return errors_.load(std::memory_order_relaxed); }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::atomic<Level> level_{Level::info};
  std::atomic<std::int64_t> errors_{0};
};

}  // namespace spark
