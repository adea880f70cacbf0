#include "status_line.h"

#include <fmt/format.h>

#include <cstdio>

#include "tree_values.h"

namespace sparkhost {

using namespace spark;

namespace {
constexpr auto kPeriod = std::chrono::milliseconds(250);
constexpr const char* kNames[] = {"trace", "debug", "info", "warning", "error", ""};
}  // namespace

void StatusLine::describe(Description<StatusLine>& d) {
  d.doc("The line that a terminal shows while a house runs.");
  d.on<&StatusLine::show>("publish");
}

void StatusLine::install(Kernel& kernel) {
  kernel.registerClass<StatusLine>();
  kernel.create("StatusLine", "/sys/host/status");
  kernel.log().setSink([](Level level, std::string_view line) { fmt::print(stderr, "\r\033[K{:<7} {}\n", kNames[static_cast<int>(level)], line); });
}

void StatusLine::show(const Event& event) {
  const auto now = Clock::now();
  if (now < next_) return;
  const double wall = std::chrono::duration<double>(now - last_).count();
  const double factor = last_ == Clock::time_point{} ? 0 : (event.time - lastTime_) / wall;
  next_ = now + kPeriod;
  last_ = now;
  lastTime_ = event.time;
  const Leaf& root = kernel().root();
  fmt::print(stderr, "\r\033[K{:8.2f} s  {}  {}:{}  {} agents  {:.1f} x real time", event.time, textAt(root, kGameState, "playMode"),
             integerAt(root, kGameState, "scoreLeft"), integerAt(root, kGameState, "scoreRight"), integerAt(root, kGameControl, "agentCount"), factor);
  std::fflush(stderr);
}

}  // namespace sparkhost
