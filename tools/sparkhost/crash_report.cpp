#include "crash_report.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <memory>

#include "spark/running.h"

// Signal handlers must not allocate or lock, so text is written into fixed buffers. Each thread that runs nodes has a
// separate stack for its signal handlers, so that a stack overflow can be reported, too. The handler writes its report,
// restores the previous handler and returns. Then the instruction fails again, and the process ends as if there had
// been no handler: with a core file, exit status or sanitizer report.

namespace sparkhost {

namespace {
constexpr std::size_t kStack = 64u << 10;  // bytes for handlers
constexpr std::size_t kMaxText = 1000;     // bytes of a report

const char* programName = "";
thread_local std::unique_ptr<char[]> handlerStack;

/// A crash signal and its previous handler.
struct Crash {
  int signal;
  const char* name;
  struct sigaction before = {};
};
std::array crashes{Crash{SIGSEGV, "SIGSEGV"}, Crash{SIGBUS, "SIGBUS"}, Crash{SIGFPE, "SIGFPE"}, Crash{SIGILL, "SIGILL"},
                   Crash{SIGABRT, "SIGABRT"}};

/// Appends the whole text or nothing, because short texts must not be cut.
void print(const char* text, std::size_t size) {
  while (write(STDERR_FILENO, text, size) < 0 && errno == EINTR) continue;
}

/// Appends text to a buffer; text that does not fit is dropped.
class Text {
 public:
  Text& operator<<(const char* text) {
    for (; *text && size_ < sizeof bytes_; ++text) bytes_[size_++] = *text;
    return *this;
  }
  Text& address(const void* a) {
    char digits[2 * sizeof(std::uintptr_t) + 1] = {};
    char* first = digits + sizeof digits - 1;
    auto n = reinterpret_cast<std::uintptr_t>(a);
    do *--first = "0123456789abcdef"[n % 16], n /= 16;
    while (n > 0);
    return *this << "0x" << first;
  }
  void print() const { sparkhost::print(bytes_, size_); }

 private:
  char bytes_[kMaxText];
  std::size_t size_ = 0;
};

void onCrash(int number, siginfo_t* info, void*) {
  const char* name = "";
  for (const Crash& c : crashes)
    if (c.signal == number) {
      sigaction(number, &c.before, nullptr);  // first, because the following code may crash, too
      name = c.name;
    }
  Text head;
  head << "\n" << programName << ": crashed by " << name;
  if (number == SIGSEGV || number == SIGBUS) (head << " at address ").address(info->si_addr);
  (head << " ").print();
  char words[kMaxText];
  if (const spark::Running* mine = spark::runningHere())
    print(words, spark::describeRunning(*mine, words, sizeof words));
  else
    (Text() << "in a thread that runs no nodes").print();
  (Text() << ". A debugger (gdb) shows the line.\n").print();
  // A fault of the processor repeats when the handler returns; a signal that was sent must be sent again.
  if (info->si_code <= 0) syscall(SYS_tgkill, getpid(), syscall(SYS_gettid), number);
}

void giveHandlerStack() {
  stack_t old = {};
  if (sigaltstack(nullptr, &old) != 0 || !(old.ss_flags & SS_DISABLE)) return;  // a sanitizer has set one already
  handlerStack = std::make_unique<char[]>(kStack);
  stack_t s = {};
  s.ss_sp = handlerStack.get();
  s.ss_size = kStack;
  sigaltstack(&s, nullptr);
}

void takeHandlerStack() {
  if (!handlerStack) return;
  stack_t none = {};
  none.ss_flags = SS_DISABLE;
  sigaltstack(&none, nullptr);
}
}  // namespace

void installCrashReport(const char* program) {
  programName = program;
  spark::watchThreads(giveHandlerStack, takeHandlerStack);
  for (Crash& c : crashes) {
    struct sigaction action = {};
    action.sa_sigaction = onCrash;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    sigaction(c.signal, &action, &c.before);
  }
}

}  // namespace sparkhost
