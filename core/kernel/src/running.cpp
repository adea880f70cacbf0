#include "spark/running.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <cstring>
#include <string>

#include "spark/class_object.h"
#include "spark/node.h"
#include "spark/plugin_object.h"

// describeRunning() runs in signal handlers, which may allocate nothing and take no lock: text goes into fixed buffers.

namespace spark {

namespace {
constexpr std::size_t kRecords = 128;  // threads that run nodes at a time; further ones are not watched
constexpr std::size_t kDeepest = 64;   // nodes of a path

Running records[kRecords];
[[gnu::tls_model("initial-exec")]] thread_local Running* mine = nullptr;
void (*onThreadBegin)() = nullptr;
void (*onThreadEnd)() = nullptr;

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

/// A record of the table for as long as the thread lives, or one of its own when all are taken.
struct Claim {
  Claim() {
    mine = &own;
    for (Running& r : records) {
      int none = 0;
      if (r.thread.compare_exchange_strong(none, threadNumber())) {
        mine = &r;
        break;
      }
    }
    if (onThreadBegin) onThreadBegin();
  }
  ~Claim() {
    if (onThreadEnd) onThreadEnd();
    mine->node = nullptr;
    mine->phase = nullptr;
    mine->thread = 0;
    mine = nullptr;
  }
  Running own;
};
}  // namespace

Running& running() {
  if (mine) return *mine;
  thread_local const Claim claim;
  static Running late;  // of a thread that ends: its own record has gone already
  return mine ? *mine : late;
}

const Running* runningHere() { return mine; }

std::span<const Running> runningThreads() { return records; }

void watchThreads(void (*begin)(), void (*end)()) {
  const bool known = mine != nullptr;
  onThreadBegin = begin;
  onThreadEnd = end;
  running();
  if (known) begin();
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

}  // namespace spark
