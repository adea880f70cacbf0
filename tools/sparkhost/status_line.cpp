#include "status_line.h"

#include <fmt/format.h>

#include <cstdio>

#include "api/phases.h"
#include "output.h"
#include "status_text.h"
#include "tree_values.h"

namespace sparkhost {

using namespace spark;

namespace {
constexpr auto kTerminalPeriod = std::chrono::milliseconds(250);
constexpr auto kLogPeriod = std::chrono::seconds(5);
constexpr const char* kNames[] = {"trace", "debug", "info", "warning", "error", ""};

/// Time lost against real time since the start.
std::string lossText(const Leaf& root) {
  const std::int64_t late = integerAt(root, kSimulation, "lateCycles");
  if (late == 0) return ", on time";
  return fmt::format(", lost {:.2f} s in {} late cycles", numberAt(root, kSimulation, "lostTime"), late);
}
}  // namespace

void StatusLine::describe(Description<StatusLine>& d) {
  d.doc("Shows the status of the run on stderr.");
  d.on<&StatusLine::show>(phase::kPublish);
}

void StatusLine::install(Kernel& kernel, bool terminal) {
  kernel.registerClass<StatusLine>();
  auto& line = kernel.create<StatusLine>("StatusLine", "/sys/host/status");
  line.terminal_ = terminal;
  line.last_ = Clock::now();
  line.next_ = line.last_ + kTerminalPeriod;
  if (terminal)
    kernel.log().setSink([](Level level, std::string_view text) {
      sparkhost::printError(fmt::format("\r\033[K{:<7} {}\n", kNames[static_cast<int>(level)], text));
    });
}

std::string StatusLine::text(double time, double factor) {
  const Leaf& root = kernel().root();
  std::string out = fmt::format("{:.2f} s, {:.1f} x real time", time, factor);
  if (textAt(root, kSimulation, "rate") == "real") out += lossText(root);
  out += statusText(reporters_.read(kernel()));
  if (const std::int64_t faults = kernel().faults(); faults > 0)
    out += fmt::format(", {} fault{}", faults, faults == 1 ? "" : "s");
  if (root.find(kGameControl)) out += fmt::format(", {} agents", integerAt(root, kGameControl, "agentCount"));
  return out;
}

void StatusLine::show(const Event& event) {
  const auto now = Clock::now();
  if (now < next_) return;
  const double factor = (event.time - lastTime_) / std::chrono::duration<double>(now - last_).count();
  const std::string line = text(event.time, factor);
  if (terminal_) {
    sparkhost::printError(fmt::format("\r\033[K{}", line));
    std::fflush(stderr);
  } else {
    kernel().log().info("{}", line);
  }
  next_ = now + (terminal_ ? Clock::duration(kTerminalPeriod) : Clock::duration(kLogPeriod));
  last_ = now;
  lastTime_ = event.time;
}

}  // namespace sparkhost
