#include "watchdog.h"

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <utility>

// The watchdog sends a signal to the thread that hangs. The signal handler of that thread describes what it is running.
// The nodes that it names cannot change meanwhile, because their thread is interrupted.

namespace sparkhost {

using namespace spark;

namespace {
constexpr std::size_t kLongest = 1000;  // bytes
constexpr int kAnswerWait = 5000;       // ms; on a busy machine a thread may be scheduled late

char answer[kLongest + 1];
std::atomic<std::size_t> answered{0};
int questionSignal() { return SIGRTMIN + 7; }

void onQuestion(int) {
  const int error = errno;
  if (const Running* mine = runningHere()) answered = describeRunning(*mine, answer, kLongest);
  errno = error;
}
}  // namespace

Watchdog::Watchdog() : watched_(running()) {
  struct sigaction action = {};
  action.sa_handler = onQuestion;
  action.sa_flags = SA_RESTART | SA_ONSTACK;
  sigaction(questionSignal(), &action, nullptr);
}

Watchdog::~Watchdog() { std::signal(questionSignal(), SIG_IGN); }

bool Watchdog::gotOn() {
  const bool idle = !watched_.node.load(std::memory_order_relaxed) && !watched_.file.load(std::memory_order_relaxed);
  const std::uint64_t now = watched_.beats.load(std::memory_order_relaxed);
  return std::exchange(seen_, now) != now || idle;
}

/// If a worker thread runs a node, the watched thread is waiting for it, so the worker is described instead.
const char* Watchdog::words() {
  const Running* asked = &watched_;
  for (const Running& r : runningThreads())
    if (&r != &watched_ && r.thread && r.node) asked = &r;
  answered = 0;
  answer[0] = 0;
  if (syscall(SYS_tgkill, getpid(), asked->thread.load(), questionSignal()) != 0) return "";
  for (int i = 0; i < kAnswerWait && answered == 0; ++i) {
    const timespec pause{0, 1'000'000};
    nanosleep(&pause, nullptr);
  }
  const std::size_t n = answered;
  answer[n] = 0;
  return answer;
}

}  // namespace sparkhost
