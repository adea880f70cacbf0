#include "log_sink.h"

#include <spdlog/async_logger.h>
#include <spdlog/details/thread_pool.h>

#include <atomic>
#include <cstdio>

#include "spark/error.h"

namespace spark {

namespace {
/// In the order of Level.
constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::trace, spdlog::level::debug, spdlog::level::info,
                                                 spdlog::level::warn,  spdlog::level::err,   spdlog::level::off};
}  // namespace

void LogSink::describe(Description<LogSink>& d) {
  d.doc("Receives the log beside stderr.");
  d.property("level", &LogSink::level, &LogSink::setLevel)
      .choices(levelNames())
      .doc("The lowest level that it receives, whatever the level of stderr is.");
  d.abstract();
}

void LogSink::setLevel(const std::string& name) {
  level_ = levelFromName(name);
  kernel().log().setLevel(number_, level_);
}

void LogSink::restart() {
  stop();
  if (!isLinked()) return;
  std::shared_ptr<spdlog::logger> logger;
  try {
    logger = open();
  } catch (const std::exception& e) {
    throw Error(fmt::format("{} ({}) cannot be opened", path(), classObject()->name()), e);
  }
  if (!logger) return;
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %-7l %v");
  logger->set_level(spdlog::level::trace);  // the log applies the level
  logger->flush_on(spdlog::level::trace);
  // Not through the log: that would come here again.
  const auto report = [where = fmt::format("{} ({})", path(), classObject()->name()), advice = std::string(advice()),
                       reported = std::make_shared<std::atomic<bool>>(false)](const std::string& what) {
    if (reported->exchange(true)) return;
    std::fputs(
        fmt::format("{} cannot write, and its messages are lost: {}. {}. This is reported once.\n", where, what, advice)
            .c_str(),
        stderr);
  };
  logger->set_error_handler(report);
  number_ = kernel().log().addSink(level_, [logger, most = longest()](Level level, std::string_view text) {
    const auto log = [&](std::string_view t) {
      logger->log(kLevels[static_cast<int>(level)], spdlog::string_view_t(t.data(), t.size()));
    };
    text.size() <= most ? log(text) : log(shortened(text, most));
  });
}

void LogSink::stop() {
  kernel().log().removeSink(number_);
  number_ = 0;
}

std::shared_ptr<spdlog::logger> LogSink::inThread(spdlog::sink_ptr sink) {
  // The pool must live as long as the logger, which only refers to it. When it dies it writes what waits.
  struct WithPool {
    std::shared_ptr<spdlog::details::thread_pool> pool = std::make_shared<spdlog::details::thread_pool>(kWaiting, 1);
    std::shared_ptr<spdlog::async_logger> logger;
  };
  auto both = std::make_shared<WithPool>();
  both->logger = std::make_shared<spdlog::async_logger>("log", std::move(sink), both->pool,
                                                        spdlog::async_overflow_policy::overrun_oldest);
  return {both, both->logger.get()};
}

}  // namespace spark
