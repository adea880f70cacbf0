#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "output.h"

namespace sparkbatch {

namespace {
constexpr auto kTerminalPeriod = std::chrono::milliseconds(250);
constexpr auto kLinePeriod = std::chrono::seconds(10);
constexpr std::size_t kWidth = 24;  // characters of the bar

bool onTerminal() { return isatty(STDERR_FILENO) != 0; }

std::string bar(double fraction) {
  const auto full = static_cast<std::size_t>(std::clamp(fraction, 0.0, 1.0) * kWidth);
  return fmt::format("[{}{}] ", std::string(full, '='), std::string(kWidth - full, ' '));
}

/// "1:02:03" or "2:03".
std::string clockText(double seconds) {
  const auto s = std::int64_t{std::llround(seconds)};
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}
}  // namespace

void printLine(std::string_view line) {
  sparkhost::printError(fmt::format("{}{}\n", onTerminal() ? "\r\033[K" : "", line));
}

Progress::Progress(std::int64_t runs, std::int64_t existing, double duration)
    : runs_(runs),
      existing_(existing),
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
  // Current runs count as fractions of a run, if the duration is known.
  const double seconds = std::max(elapsed(), 1e-6), partial = duration_ > 0 ? running / duration_ : 0;
  const double done = static_cast<double>(done_) + partial, left = static_cast<double>(runs_ - existing_) - done;
  std::string out = fmt::format("{} of {} runs", existing_ + done_, runs_);
  if (failed_ > 0) out += fmt::format(", {} failed", failed_);
  out += fmt::format(", {:.3g} runs/s, {:.3g} x real time", done / seconds, (simulated_ + running) / seconds);
  if (done > 0 && left > 0) out += fmt::format(", {} left", clockText(left * seconds / done));
  if (!terminal_) return out;
  return bar((static_cast<double>(existing_) + done) / static_cast<double>(std::max<std::int64_t>(runs_, 1))) + out;
}

void Progress::show(double running) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? Clock::duration(kTerminalPeriod) : Clock::duration(kLinePeriod));
  if (!terminal_) return printLine(text(running));
  sparkhost::printError(fmt::format("\r\033[K{}", text(running)));
  std::fflush(stderr);
}

void Progress::end() { printLine(text(0)); }

}  // namespace sparkbatch
