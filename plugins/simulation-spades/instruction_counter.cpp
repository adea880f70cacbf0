#include "instruction_counter.h"

#include <fmt/format.h>
#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "spark/error.h"

namespace spark::spades {

namespace {
/// A descriptor, or -1 and errno.
int openCounter(pid_t program) {
  perf_event_attr what = {};
  what.size = sizeof what;
  what.type = PERF_TYPE_HARDWARE;
  what.config = PERF_COUNT_HW_INSTRUCTIONS;
  what.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  what.inherit = 1;
  what.exclude_kernel = 1;  // with it no rights are needed
  what.exclude_hv = 1;
  return static_cast<int>(::syscall(SYS_perf_event_open, &what, program, -1, -1, PERF_FLAG_FD_CLOEXEC));
}
}  // namespace

InstructionCounter::InstructionCounter(pid_t program) : descriptor_(openCounter(program)) {
  if (descriptor_ < 0) throw Error(lacks(errno));
}

InstructionCounter::~InstructionCounter() { ::close(descriptor_); }

double InstructionCounter::count() const {
  std::array<std::uint64_t, 3> reading = {};
  if (::read(descriptor_, reading.data(), sizeof reading) != sizeof reading) return 0;
  return scaled(reading[0], reading[1], reading[2]);
}

double InstructionCounter::scaled(std::uint64_t counted, std::uint64_t enabled, std::uint64_t running) {
  if (running == 0) return 0;
  return static_cast<double>(counted) * (static_cast<double>(enabled) / static_cast<double>(running));
}

std::string InstructionCounter::lacks() {
  const int descriptor = openCounter(0);
  if (descriptor < 0) return lacks(errno);
  ::close(descriptor);
  return {};
}

std::string InstructionCounter::lacks(int error) {
  if (error == 0) return {};
  const bool forbidden = error == EACCES || error == EPERM;
  return fmt::format("{} (perf_event_open: {}); {}use CpuThinkTime, or the timer 'jiffies', instead",
                     forbidden ? "this user may not count the instructions of programs"
                               : "this machine cannot count the instructions of programs, as most virtual machines",
                     std::strerror(error),
                     forbidden ? "set /proc/sys/kernel/perf_event_paranoid to 2 or less, or " : "");
}

}  // namespace spark::spades
