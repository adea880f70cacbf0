#include "spark/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <mutex>

#include "spark/error.h"
#include "spark/printable.h"

namespace spark {

std::string shortened(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return std::string(text);
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0) == 0x80) --bytes;
  return fmt::format("{} ... ({} bytes were cut)", text.substr(0, bytes), text.size() - bytes);
}

struct Log::Impl {
  struct Further {
    int number;
    Level level;
    Sink sink;
  };
  std::mutex mutex;
  Sink sink;                     ///< in place of stderr
  std::vector<Further> further;  ///< beside it
  int lastNumber = 0;
  spdlog::logger logger{"spark", std::make_shared<spdlog::sinks::stderr_color_sink_mt>()};
};

Log::Log() : impl_(std::make_unique<Impl>()) {
  impl_->logger.set_pattern("%H:%M:%S.%e %^%-7l%$ %v");
  impl_->logger.set_level(spdlog::level::trace);  // write() applies the level of this log
}
Log::~Log() = default;

const std::vector<std::string>& levelNames() {
  static const std::vector<std::string> names{"trace", "debug", "info", "warning", "error", "off"};
  return names;
}

const std::string& nameOf(Level level) { return levelNames()[static_cast<std::size_t>(level)]; }

Level levelFromName(std::string_view name) {
  const std::vector<std::string>& names = levelNames();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Level>(i);
  throw Error(
      fmt::format("expected a log level ({}), found '{}'.{}", fmt::join(names, ", "), name, didYouMean(name, names)));
}

void Log::setLevel(Level level) {
  const std::lock_guard lock(impl_->mutex);
  level_ = level;
  updateLowest();
}

void Log::setSink(Sink sink) {
  const std::lock_guard lock(impl_->mutex);
  impl_->sink = std::move(sink);
}

int Log::addSink(Level level, Sink sink) {
  const std::lock_guard lock(impl_->mutex);
  impl_->further.push_back({++impl_->lastNumber, level, std::move(sink)});
  updateLowest();
  return impl_->lastNumber;
}

void Log::setLevel(int sink, Level level) {
  const std::lock_guard lock(impl_->mutex);
  for (Impl::Further& f : impl_->further)
    if (f.number == sink) f.level = level;
  updateLowest();
}

void Log::removeSink(int sink) {
  const std::lock_guard lock(impl_->mutex);
  std::erase_if(impl_->further, [sink](const Impl::Further& f) { return f.number == sink; });
  updateLowest();
}

/// The mutex is locked.
void Log::updateLowest() {
  Level lowest = level_;
  for (const Impl::Further& f : impl_->further) lowest = std::min(lowest, f.level);
  lowest_ = lowest;
}

void Log::write(Level level, std::string_view line) {
  if (level == Level::error) errors_.fetch_add(1, std::memory_order_relaxed);
  if (!enabled(level)) return;
  std::string clean = printable(line);
  // Lines after the first are indented, so that text from a client cannot imitate another log message.
  for (std::size_t at = 0; (at = clean.find('\n', at)) != std::string::npos; ++at)
    if (at + 1 == clean.size() || clean[at + 1] != ' ') clean.insert(at + 1, "  ");
  const std::lock_guard lock(impl_->mutex);
  for (const Impl::Further& f : impl_->further)
    if (level >= f.level) f.sink(level, clean);
  if (level < level_) return;
  if (impl_->sink) return impl_->sink(level, clean);
  // In the order of Level.
  constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::trace, spdlog::level::debug, spdlog::level::info,
                                                   spdlog::level::warn,  spdlog::level::err,   spdlog::level::off};
  impl_->logger.log(kLevels[static_cast<int>(level)], "{}", clean);
}

}  // namespace spark
