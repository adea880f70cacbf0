#include "spark/running.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>

#include "spark/class_object.h"
#include "spark/kernel.h"

// Signal handlers may allocate nothing and take no lock. So words go into fixed buffers, by hand, and each thread that
// has a record also has a stack for its handlers: a thread that used up its own can say so.
//
// A crash: the handler says its words, puts back what handled the signal before and returns. The instruction fails
// again and the process ends as if nobody had looked: core, exit status, a sanitizer's report. A watchdog's question is
// a signal to the thread that hangs, which writes the answer itself: the nodes it names cannot change meanwhile.

namespace spark {

namespace {
constexpr std::size_t kRecords = 128;      // threads that run nodes at a time; further ones are not watched
constexpr std::size_t kStack = 64u << 10;  // bytes for handlers
constexpr std::size_t kDeepest = 64;       // nodes of a path

Running records[kRecords];
[[gnu::tls_model("initial-exec")]] thread_local Running* mine = nullptr;
const char* volatile programName = nullptr;  // set: crashes are told
/// A signal that tells of a crash, and what handled it before.
struct Crash {
  int signal;
  struct sigaction before = {};
};
std::array crashes{Crash{SIGSEGV}, Crash{SIGBUS}, Crash{SIGFPE}, Crash{SIGILL}, Crash{SIGABRT}};

int threadNumber() { return static_cast<int>(syscall(SYS_gettid)); }

/// Words in a buffer; what does not fit is left out.
class Words {
 public:
  Words(char* to, std::size_t size) : at_(to), begin_(to), end_(to + size) {}
  Words& operator<<(const char* text) { return add(text, std::strlen(text)); }
  Words& operator<<(const std::string& text) { return add(text.data(), text.size()); }
  Words& number(std::uint64_t n, unsigned base) {
    char digits[24];
    std::size_t i = sizeof digits;
    do digits[--i] = "0123456789abcdef"[n % base], n /= base;
    while (n > 0);
    return add(digits + i, sizeof digits - i);
  }
  std::size_t size() const { return static_cast<std::size_t>(at_ - begin_); }

 private:
  Words& add(const char* text, std::size_t n) {
    for (; n > 0 && at_ < end_; --n, ++text)
      *at_++ = static_cast<unsigned char>(*text) < 0x20 || *text == 0x7f ? '?' : *text;
    return *this;
  }
  char *at_, *begin_, *end_;
};

/// As Leaf::path(), without memory.
void addPath(const Leaf& leaf, Words& words) {
  const Leaf* way[kDeepest];
  std::size_t depth = 0;
  for (const Leaf* at = &leaf; at && depth < kDeepest; at = at->parent()) way[depth++] = at;
  if (depth == kDeepest) words << "...";
  for (std::size_t i = depth; i-- > 0;) {
    const Node* parent = way[i]->parent();
    if (!parent && way[i]->isLinked()) {
      if (depth == 1) words << "/";
      continue;  // the root
    }
    words << (parent ? "/" : "") << way[i]->name();
    if (!parent) continue;
    std::uint64_t index = 1;
    for (const auto& brother : parent->children()) {
      if (brother.get() == way[i]) break;
      index += brother->name() == way[i]->name();
    }
    if (index > 1) (words << "[").number(index, 10) << "]";
  }
}

void addClass(const ClassObject& c, Words& words) {
  words << "class " << c.name();
  if (c.plugin()) words << " of plugin " << c.plugin()->name();
}

const char* nameOf(int number) {
  switch (number) {
    case SIGSEGV:
      return "SIGSEGV";
    case SIGBUS:
      return "SIGBUS";
    case SIGFPE:
      return "SIGFPE";
    case SIGILL:
      return "SIGILL";
    default:
      return "SIGABRT";
  }
}

/// In one piece, or not at all: short texts are not cut.
void say(const char* text, std::size_t size) {
  while (write(STDERR_FILENO, text, size) < 0 && errno == EINTR) continue;
}

void onCrash(int number, siginfo_t* info, void*) {
  for (const Crash& c : crashes)  // first: what follows may crash as well
    if (c.signal == number) sigaction(number, &c.before, nullptr);
  char text[Watchdog::kLongest];
  Words head(text, sizeof text);
  head << programName << ": crashed by " << nameOf(number);
  if (number == SIGSEGV || number == SIGBUS)
    (head << " at address 0x").number(reinterpret_cast<std::uintptr_t>(info->si_addr), 16);
  say("\n", 1);
  say(text, head.size());
  say(" ", 1);
  if (mine)
    say(text, describeRunning(*mine, text, sizeof text));
  else
    say("in a thread that runs no nodes", 30);
  constexpr char kHint[] = ". A debugger (gdb) shows the line.\n";
  say(kHint, sizeof kHint - 1);
  // What the processor found it finds again; what was sent has to be sent again.
  if (info->si_code <= 0) syscall(SYS_tgkill, getpid(), threadNumber(), number);
}

/// Of the thread that installed it, or that a pool started afterwards.
void giveStack(std::unique_ptr<char[]>& stack) {
  stack_t old = {};
  if (sigaltstack(nullptr, &old) != 0 || !(old.ss_flags & SS_DISABLE)) return;  // a sanitizer's
  stack = std::make_unique<char[]>(kStack);
  stack_t s = {};
  s.ss_sp = stack.get();
  s.ss_size = kStack;
  sigaltstack(&s, nullptr);
}

void takeStack(const std::unique_ptr<char[]>& stack) {
  if (!stack) return;
  stack_t none = {};
  none.ss_flags = SS_DISABLE;
  sigaltstack(&none, nullptr);
}

/// A record of the table for as long as the thread lives, or one of its own when all are taken.
struct Claim {
  Claim() {
    Running* free = nullptr;
    for (Running& r : records) {
      int none = 0;
      if (r.thread.compare_exchange_strong(none, threadNumber())) {
        free = &r;
        break;
      }
    }
    mine = free ? free : &own;
    if (programName) giveStack(stack);
  }
  ~Claim() {
    takeStack(stack);
    mine->node = nullptr;
    mine->phase = nullptr;
    mine->thread = 0;
    mine = nullptr;
  }
  Running own;
  std::unique_ptr<char[]> stack;
};

// The watchdog's question and its answer.
char answer[Watchdog::kLongest + 1];
std::atomic<std::size_t> answered{0};
int questionSignal() { return SIGRTMIN + 7; }

void onQuestion(int) {
  const int error = errno;
  if (mine) answered = describeRunning(*mine, answer, Watchdog::kLongest);
  errno = error;
}
}  // namespace

Running& running() {
  if (mine) return *mine;
  thread_local const Claim claim;
  static Running late;  // of a thread that ends: its own record has gone already
  return mine ? *mine : late;
}

std::size_t describeRunning(const Running& now, char* text, std::size_t size) {
  Words words(text, size);
  if (const char* file = now.file) {
    words << "while it loaded plugin " << file;
    return words.size();
  }
  const Leaf* node = now.node;
  const char* phase = now.phase;
  if (!node) {
    words << "outside of the code of nodes";
    return words.size();
  }
  const auto* made =
      node->classObject() && node->classObject()->name() == "Class" ? static_cast<const ClassObject*>(node) : nullptr;
  words << "in " << (phase ? phase : "code") << " of ";
  if (made) return addClass(*made, words), words.size();
  addPath(*node, words);
  words << " (";
  if (node->classObject()) addClass(*node->classObject(), words);
  words << ")";
  return words.size();
}

void installLastWords(const char* program) {
  programName = program;
  running();
  for (Crash& c : crashes) {
    struct sigaction action = {};
    action.sa_sigaction = onCrash;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    sigaction(c.signal, &action, &c.before);
  }
}

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

/// A thread of a pool that runs a node is what the watched one waits for.
const char* Watchdog::words() {
  const Running* asked = &watched_;
  for (const Running& r : records)
    if (&r != &watched_ && r.thread && r.node) asked = &r;
  answered = 0;
  answer[0] = 0;
  if (syscall(SYS_tgkill, getpid(), asked->thread.load(), questionSignal()) != 0) return "";
  for (int i = 0; i < 100 && answered == 0; ++i) {
    const timespec pause{0, 1'000'000};
    nanosleep(&pause, nullptr);
  }
  const std::size_t n = answered;
  answer[n] = 0;
  return answer;
}

}  // namespace spark
