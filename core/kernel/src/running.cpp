#include "spark/running.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <cstring>
#include <string>

#include "spark/class_object.h"
#include "spark/node.h"
#include "spark/plugin_object.h"

// describeRunning() runs in signal handlers, which must not allocate or lock: text is written to fixed buffers.

namespace spark {

namespace {
constexpr std::size_t kRecords = 128;  // threads that run nodes at the same time; further ones are not watched
constexpr std::size_t kDeepest = 64;   // maximum number of names in a path; of a longer path the last names are shown

Running records[kRecords];
/// The record of this thread. This TLS model reads it without a call that could allocate.
[[gnu::tls_model("initial-exec")]] thread_local Running* mine = nullptr;
void (*onThreadBegin)() = nullptr;
void (*onThreadEnd)() = nullptr;

int threadNumber() { return static_cast<int>(syscall(SYS_gettid)); }

/// Text in a buffer. What does not fit is omitted.
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
  /// Control characters become '?'.
  Words& add(const char* text, std::size_t n) {
    for (; n > 0 && at_ < end_; --n, ++text)
      *at_++ = static_cast<unsigned char>(*text) < 0x20 || *text == 0x7f ? '?' : *text;
    return *this;
  }
  char *at_, *begin_, *end_;
};

/// As Leaf::path(), without allocation.
void addPath(const Leaf& leaf, Words& words) {
  const Leaf* ancestors[kDeepest];
  std::size_t depth = 0;
  for (const Leaf* at = &leaf; at && depth < kDeepest; at = at->parent()) ancestors[depth++] = at;
  if (depth == kDeepest) words << "...";
  for (std::size_t i = depth; i-- > 0;) {
    const Leaf& at = *ancestors[i];
    const Node* parent = at.parent();
    // The name of the root is shown only as its own path.
    if (!parent && at.isLinked()) {
      if (depth == 1) words << "/";
      continue;
    }
    words << (parent ? "/" : "") << at.name();
    if (!parent) continue;
    std::uint64_t ordinal = 1;
    for (const auto& sibling : parent->children()) {
      if (sibling.get() == &at) break;
      ordinal += sibling->name() == at.name();
    }
    if (ordinal > 1) (words << "[").number(ordinal, 10) << "]";
  }
}

void addClass(const ClassObject& c, Words& words) {
  words << "class " << c.name();
  if (c.plugin()) words << " of plugin " << c.plugin()->name();
}

/// Holds a free record for the life of its thread, or a private one if none is free.
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
  static Running late;  // for a thread that is ending and has released its record
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
