#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace sparkbatch {

namespace {
constexpr auto kTerminalPeriod = std::chrono::milliseconds(250);
constexpr auto kLinePeriod = std::chrono::seconds(10);
constexpr int kWidth = 24;

bool onTerminal() { return isatty(STDERR_FILENO) != 0; }

std::string bar(double part) {
  const int full = static_cast<int>(std::clamp(part, 0.0, 1.0) * kWidth);
  return "[" + std::string(static_cast<std::size_t>(full), '=') +
         std::string(static_cast<std::size_t>(kWidth - full), ' ') + "] ";
}

/// "1:02:03" or "2:03".
std::string clockText(double seconds) {
  const auto s = static_cast<std::int64_t>(seconds + 0.5);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}
}  // namespace

void sayLine(std::string_view line) { fmt::print(stderr, "{}{}\n", onTerminal() ? "\r\033[K" : "", line); }

Progress::Progress(std::int64_t runs, std::int64_t there, double duration)
    : runs_(runs),
      there_(there),
      duration_(duration),
      terminal_(onTerminal()),
      next_(begin_ + (terminal_ ? Clock::duration(0) : Clock::duration(kLinePeriod))) {}

double Progress::elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

void Progress::add(double simulatedSeconds, bool failed) {
  ++done_;
  failed_ += failed;
  simulated_ += simulatedSeconds;
}

std::string Progress::text(double running) const {
  const double seconds = std::max(elapsed(), 1e-6), begun = duration_ > 0 ? running / duration_ : 0;
  const double now = static_cast<double>(done_) + begun, left = static_cast<double>(runs_ - there_) - now;
  std::string out = fmt::format("{} of {} runs", there_ + done_, runs_);
  if (failed_ > 0) out += fmt::format(", {} failed", failed_);
  out += fmt::format(", {:.3g} runs/s, {:.3g} x real time", now / seconds, (simulated_ + running) / seconds);
  if (now > 0 && left > 0) out += fmt::format(", {} left", clockText(left * seconds / now));
  if (!terminal_) return out;
  return bar((static_cast<double>(there_) + now) / static_cast<double>(std::max<std::int64_t>(runs_, 1))) + out;
}

void Progress::show(double running) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? Clock::duration(kTerminalPeriod) : Clock::duration(kLinePeriod));
  if (!terminal_) return sayLine(text(running));
  fmt::print(stderr, "\r\033[K{}", text(running));
  std::fflush(stderr);
}

void Progress::end() { sayLine(text(0)); }

}  // namespace sparkbatch
