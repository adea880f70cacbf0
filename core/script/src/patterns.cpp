#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

#include "environment.h"
#include "spark/error.h"
#include "state.h"
#include "values.h"

// find, match, gmatch and gsub as in Lua 5.4 (reference manual, sections 6.4 and 6.4.1). Lua's own functions count as
// one instruction however long they take, and a pattern such as ".-.-.-b" takes exponential time. These charge an
// instruction for each comparison.
//
// Positions are pointers into the subject (`at`, `to`) and into the pattern (`p`). A function that matches a piece of
// the pattern returns the end of the match in the subject, or nullptr.

namespace spark::script {

namespace patterns {
constexpr int kMaxCaptures = 32;
constexpr int kMaxDepth = 200;  // nested calls of match()
// Lengths of captures that have none: one that is not closed yet, and a position capture.
constexpr std::ptrdiff_t kOpen = -1, kPosition = -2;

/// Matches a pattern at a position, and keeps the captures.
class Matcher {
 public:
  Matcher(lua_State* L, std::string_view subject, std::string_view pattern)
      : L_(L),
        state_(State::of(L)),
        begin_(subject.data()),
        end_(begin_ + subject.size()),
        patternEnd_(pattern.data() + pattern.size()) {}

  /// Matches `pattern` at `at`, without the captures of earlier attempts.
  const char* start(const char* at, const char* pattern) {
    captureCount_ = 0;
    depthLeft_ = kMaxDepth;
    return match(at, pattern);
  }
  const char* begin() const { return begin_; }
  const char* end() const { return end_; }

  /// Pushes capture `i`, from 0, of the match [from, to). Without captures the first one is the whole match.
  void push(int i, const char* from, const char* to) const {
    if (i >= captureCount_) {
      if (i != 0) throw Error(fmt::format("invalid capture index %{}", i + 1));
      pushText(L_, {from, to});
      return;
    }
    const Capture& c = captures_[i];
    if (c.length == kPosition)
      lua_pushinteger(L_, c.begin - begin_ + 1);
    else if (c.length == kOpen)
      throw Error("unfinished capture");
    else
      pushText(L_, {c.begin, c.begin + c.length});
  }
  /// Pushes all captures of the match [from, to), or the whole match if there are none and `from` is not nullptr.
  /// Returns their number.
  int pushAll(const char* from, const char* to) const {
    const int n = captureCount_ == 0 && from ? 1 : captureCount_;
    luaL_checkstack(L_, n, "too many captures");
    for (int i = 0; i < n; ++i) push(i, from, to);
    return n;
  }

 private:
  struct Capture {
    const char* begin;
    std::ptrdiff_t length;
  };

  /// Charges for a comparison.
  void charge() { state_.charge(L_); }

  /// True if character `c` is in the class `%letter`.
  static bool inClass(int c, int letter) {
    bool in = false;
    switch (std::tolower(letter)) {
      case 'a':
        in = std::isalpha(c) != 0;
        break;
      case 'c':
        in = std::iscntrl(c) != 0;
        break;
      case 'd':
        in = std::isdigit(c) != 0;
        break;
      case 'g':
        in = std::isgraph(c) != 0;
        break;
      case 'l':
        in = std::islower(c) != 0;
        break;
      case 'p':
        in = std::ispunct(c) != 0;
        break;
      case 's':
        in = std::isspace(c) != 0;
        break;
      case 'u':
        in = std::isupper(c) != 0;
        break;
      case 'w':
        in = std::isalnum(c) != 0;
        break;
      case 'x':
        in = std::isxdigit(c) != 0;
        break;
      case 'z':
        in = c == 0;
        break;
      default:
        return letter == c;
    }
    return std::isupper(letter) ? !in : in;
  }

  static int byte(const char* p) { return static_cast<unsigned char>(*p); }

  /// The end of the single character class that begins at p.
  const char* classEnd(const char* p) const {
    if (*p++ == '%') {
      if (p == patternEnd_) throw Error("malformed pattern (ends with '%')");
      return p + 1;
    }
    if (p[-1] != '[') return p;
    if (p < patternEnd_ && *p == '^') ++p;
    do {  // a ']' in front is an element of the set
      if (p == patternEnd_) throw Error("malformed pattern (missing ']')");
      if (*p++ == '%') {
        if (p == patternEnd_) throw Error("malformed pattern (missing ']')");
        ++p;
      }
    } while (p == patternEnd_ || *p != ']');
    return p + 1;
  }

  /// True if character `c` is in the set whose '[' is at `p` and whose ']' is at `last`.
  static bool inSet(int c, const char* p, const char* last) {
    bool wanted = true;
    if (p[1] == '^') wanted = false, ++p;
    while (++p < last) {
      if (*p == '%') {
        if (inClass(c, byte(++p))) return wanted;
      } else if (p[1] == '-' && p + 2 < last) {
        p += 2;
        if (byte(p - 2) <= c && c <= byte(p)) return wanted;
      } else if (byte(p) == c) {
        return wanted;
      }
    }
    return !wanted;
  }

  /// True if the character at `at` matches the class [p, classEnd).
  bool matchesOne(const char* at, const char* p, const char* classEnd) {
    charge();
    if (at >= end_) return false;
    switch (*p) {
      case '.':
        return true;
      case '%':
        return inClass(byte(at), byte(p + 1));
      case '[':
        return inSet(byte(at), p, classEnd - 1);
      default:
        return byte(p) == byte(at);
    }
  }

  /// %bxy, with `p` at the x.
  const char* matchBalanced(const char* at, const char* p) {
    if (p + 1 >= patternEnd_) throw Error("malformed pattern (missing arguments to '%b')");
    if (at >= end_ || *at != p[0]) return nullptr;
    int open = 1;
    for (const char* s = at + 1; s < end_; ++s) {
      charge();
      if (*s == p[1]) {
        if (--open == 0) return s + 1;
      } else if (*s == p[0]) {
        ++open;
      }
    }
    return nullptr;
  }

  /// The class [p, classEnd) with the suffix '*', and the rest of the pattern: as many characters as possible.
  const char* matchMost(const char* at, const char* p, const char* classEnd) {
    std::ptrdiff_t n = 0;
    while (matchesOne(at + n, p, classEnd)) ++n;
    for (; n >= 0; --n)
      if (const char* to = match(at + n, classEnd + 1)) return to;
    return nullptr;
  }

  /// The class [p, classEnd) with the suffix '-', and the rest of the pattern: as few characters as possible.
  const char* matchLeast(const char* at, const char* p, const char* classEnd) {
    for (;; ++at) {
      if (const char* to = match(at, classEnd + 1)) return to;
      if (!matchesOne(at, p, classEnd)) return nullptr;
    }
  }

  /// Begins a capture and matches the rest of the pattern. `length`: kOpen or kPosition.
  const char* openCapture(const char* at, const char* p, std::ptrdiff_t length) {
    if (captureCount_ >= kMaxCaptures) throw Error("too many captures");
    captures_[captureCount_++] = {at, length};
    const char* to = match(at, p);
    if (!to) --captureCount_;
    return to;
  }

  /// Ends the innermost open capture and matches the rest of the pattern.
  const char* closeCapture(const char* at, const char* p) {
    int i = captureCount_ - 1;
    while (i >= 0 && captures_[i].length != kOpen) --i;
    if (i < 0) throw Error("invalid pattern capture");
    captures_[i].length = at - captures_[i].begin;
    const char* to = match(at, p);
    if (!to) captures_[i].length = kOpen;
    return to;
  }

  /// %1 to %9: the text of a capture.
  const char* matchCapture(const char* at, int digit) {
    const int i = digit - '1';
    if (i < 0 || i >= captureCount_ || captures_[i].length == kOpen)
      throw Error(fmt::format("invalid capture index %{}", i + 1));
    const Capture& c = captures_[i];
    if (c.length == kPosition) return nullptr;  // it has no text
    if (end_ - at < c.length) return nullptr;
    const std::size_t length = c.length;
    state_.charge(L_, length / kBytesPerInstruction);
    if (std::memcmp(c.begin, at, length) != 0) return nullptr;
    return at + length;
  }

  /// %f[set]: the set [p, setEnd) begins at `at`.
  bool isFrontier(const char* at, const char* p, const char* setEnd) {
    const int before = at == begin_ ? 0 : byte(at - 1), here = at < end_ ? byte(at) : 0;
    return !inSet(before, p, setEnd - 1) && inSet(here, p, setEnd - 1);
  }

  /// Matches the pattern from `p` to its end.
  const char* match(const char* at, const char* p) {
    struct Depth {
      int& left;
      explicit Depth(int& l) : left(l) {
        if (left-- == 0) throw Error("pattern too complex");
      }
      ~Depth() { ++left; }
    } depth(depthLeft_);
    for (;;) {
      charge();
      if (p == patternEnd_) return at;

      // Items that are not single character classes.
      switch (*p) {
        case '(':
          return p + 1 < patternEnd_ && p[1] == ')' ? openCapture(at, p + 2, kPosition) : openCapture(at, p + 1, kOpen);
        case ')':
          return closeCapture(at, p + 1);
        case '$':
          if (p + 1 == patternEnd_) return at == end_ ? at : nullptr;
          break;
        case '%':
          if (p + 1 == patternEnd_) break;
          if (p[1] == 'b') {
            at = matchBalanced(at, p + 2);
            if (!at) return nullptr;
            p += 4;
            continue;
          }
          if (p[1] == 'f') {
            p += 2;
            if (p == patternEnd_ || *p != '[') throw Error("missing '[' after '%f' in pattern");
            const char* setEnd = classEnd(p);
            if (!isFrontier(at, p, setEnd)) return nullptr;
            p = setEnd;
            continue;
          }
          if (std::isdigit(byte(p + 1))) {
            at = matchCapture(at, byte(p + 1));
            if (!at) return nullptr;
            p += 2;
            continue;
          }
          break;
        default:
          break;
      }

      // A single character class with its suffix.
      const char* end = classEnd(p);
      const char suffix = end < patternEnd_ ? *end : '\0';
      if (suffix == '*') return matchMost(at, p, end);
      if (suffix == '-') return matchLeast(at, p, end);
      if (suffix == '+') return matchesOne(at, p, end) ? matchMost(at + 1, p, end) : nullptr;
      const bool matches = matchesOne(at, p, end);
      if (suffix == '?') {
        if (matches)
          if (const char* to = match(at + 1, end + 1)) return to;
        p = end + 1;
        continue;
      }
      if (!matches) return nullptr;
      ++at;
      p = end;
    }
  }

  lua_State* L_;
  State& state_;
  const char *begin_, *end_;  // of the subject
  const char* patternEnd_;
  int captureCount_ = 0;
  int depthLeft_ = kMaxDepth;
  std::array<Capture, kMaxCaptures> captures_;
};

/// The string or number at `index` as text. Lua error for other types.
static std::string_view text(lua_State* L, int index) {
  luaL_checklstring(L, index, nullptr);
  return textAt(L, index);
}

/// The offset at which a search begins, from the optional argument at `index`: a position from 1, or from the end if it
/// is negative. A position beyond the end becomes length + 1.
static std::size_t beginOffset(lua_State* L, int index, std::size_t length) {
  const lua_Integer at = luaL_optinteger(L, index, 1);
  const auto n = static_cast<lua_Integer>(length);
  if (at > 0) return std::min(at - 1, n + 1);
  if (at == 0 || at < -n) return 0;
  return n + at;
}

/// The offset of the first `what` at or behind `from`; npos if there is none.
static std::size_t findPlain(lua_State* L, std::string_view subject, std::string_view what, std::size_t from) {
  State& state = State::of(L);
  while (!what.empty()) {
    const std::size_t at = std::min(subject.find(what[0], from), subject.size());
    state.charge(L, 1 + (at - from + what.size()) / kBytesPerInstruction);
    if (what.size() > subject.size() - at) return std::string_view::npos;
    if (subject.compare(at, what.size(), what) == 0) return at;
    from = at + 1;
  }
  return from;
}

/// find or match.
static int search(lua_State* L, bool find) {
  const std::string_view subject = text(L, 1), pattern = text(L, 2);
  const std::size_t from = beginOffset(L, 3, subject.size());
  if (from > subject.size()) {
    luaL_pushfail(L);
    return 1;
  }

  // A text without special characters.
  if (find && (lua_toboolean(L, 4) || pattern.find_first_of("^$*+?.([%-") == std::string_view::npos)) {
    const std::size_t at = findPlain(L, subject, pattern, from);
    if (at == std::string_view::npos) {
      luaL_pushfail(L);
      return 1;
    }
    const auto begin = static_cast<lua_Integer>(at);
    lua_pushinteger(L, begin + 1);
    lua_pushinteger(L, begin + static_cast<lua_Integer>(pattern.size()));
    return 2;
  }

  // A pattern, tried at each position.
  Matcher m(L, subject, pattern);
  const bool anchored = pattern.starts_with('^');
  const char* const first = pattern.data() + (anchored ? 1 : 0);
  for (const char* at = m.begin() + from; at <= m.end(); ++at) {
    if (const char* to = m.start(at, first)) {
      if (!find) return m.pushAll(at, to);
      lua_pushinteger(L, at - m.begin() + 1);
      lua_pushinteger(L, to - m.begin());
      return m.pushAll(nullptr, nullptr) + 2;
    }
    if (anchored) break;
  }
  luaL_pushfail(L);
  return 1;
}

static int find(lua_State* L) { return search(L, true); }
static int match(lua_State* L) { return search(L, false); }

/// The iterator of gmatch. Upvalues: subject, pattern, the offset at which to continue, and the offset at which the
/// last match ended (-1 before the first).
static int nextMatch(lua_State* L) {
  const std::string_view subject = text(L, lua_upvalueindex(1)), pattern = text(L, lua_upvalueindex(2));
  Matcher m(L, subject, pattern);
  const lua_Integer last = lua_tointeger(L, lua_upvalueindex(4));
  for (const char* at = m.begin() + lua_tointeger(L, lua_upvalueindex(3)); at <= m.end(); ++at) {
    const char* to = m.start(at, pattern.data());
    if (!to || to - m.begin() == last) continue;  // not an empty match behind the last one
    lua_pushinteger(L, to - m.begin());
    lua_pushvalue(L, -1);
    lua_replace(L, lua_upvalueindex(3));
    lua_replace(L, lua_upvalueindex(4));
    return m.pushAll(at, to);
  }
  return 0;
}

static int gmatch(lua_State* L) {
  const std::string_view subject = text(L, 1);
  text(L, 2);
  const std::size_t from = beginOffset(L, 3, subject.size());
  lua_settop(L, 2);
  lua_pushinteger(L, static_cast<lua_Integer>(from));
  lua_pushinteger(L, -1);
  lua_pushcclosure(L, guarded<nextMatch>, 4);
  return 1;
}

/// Appends a replacement text, with the captures for %0 to %9.
static void appendTemplate(lua_State* L, const Matcher& m, std::string& out, const char* from, const char* to) {
  const std::string_view with = text(L, 3);
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (with[i] != '%') {
      out += with[i];
      continue;
    }
    const char c = ++i < with.size() ? with[i] : '\0';
    if (c == '%') {
      out += c;
    } else if (c == '0') {
      out.append(from, to);
    } else if (std::isdigit(static_cast<unsigned char>(c))) {
      m.push(c - '1', from, to);
      luaL_tolstring(L, -1, nullptr);  // a position is a number
      out += textAt(L, -1);
      lua_pop(L, 2);
    } else {
      throw Error("invalid use of '%' in replacement string");
    }
  }
}

/// Appends the replacement of a match. Returns false if the match is kept.
static bool appendReplacement(lua_State* L, const Matcher& m, std::string& out, const char* from, const char* to) {
  const int type = lua_type(L, 3);
  if (type == LUA_TNUMBER || type == LUA_TSTRING) {
    appendTemplate(L, m, out, from, to);
    return true;
  }
  if (type == LUA_TFUNCTION) {
    lua_pushvalue(L, 3);
    lua_call(L, m.pushAll(from, to), 1);
  } else {
    m.push(0, from, to);
    lua_gettable(L, 3);
  }
  if (!lua_toboolean(L, -1)) {
    lua_pop(L, 1);
    out.append(from, to);
    return false;
  }
  if (!lua_isstring(L, -1)) throw Error(fmt::format("invalid replacement value (a {})", luaL_typename(L, -1)));
  out += textAt(L, -1);
  lua_pop(L, 1);
  return true;
}

static int gsub(lua_State* L) {
  const std::string_view subject = text(L, 1), pattern = text(L, 2);
  const int type = lua_type(L, 3);
  const lua_Integer most = luaL_optinteger(L, 4, static_cast<lua_Integer>(subject.size()) + 1);
  luaL_argexpected(L, type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TFUNCTION || type == LUA_TTABLE, 3,
                   "string/function/table");

  const bool anchored = pattern.starts_with('^');
  const char* const first = pattern.data() + (anchored ? 1 : 0);
  Matcher m(L, subject, pattern);
  std::string out;
  const char *at = m.begin(), *last = nullptr;
  lua_Integer n = 0;
  bool changed = false;
  while (n < most) {
    // Replace a match, unless it is an empty one behind the last; else keep a character.
    const char* to = m.start(at, first);
    if (to && to != last) {
      ++n;
      const std::size_t before = out.size();
      changed |= appendReplacement(L, m, out, at, to);
      State::of(L).charge(L, (out.size() - before) / kBytesPerInstruction);
      at = last = to;
    } else if (at < m.end()) {
      out += *at++;
    } else {
      break;
    }
    if (anchored) break;
  }
  if (changed) {
    out.append(at, m.end());
    pushText(L, out);
  } else {
    lua_pushvalue(L, 1);
  }
  lua_pushinteger(L, n);
  return 2;
}
}  // namespace patterns

void openPatterns(lua_State* L) {
  using namespace patterns;
  constexpr luaL_Reg kFunctions[] = {{"find", guarded<find>},
                                     {"match", guarded<match>},
                                     {"gmatch", guarded<gmatch>},
                                     {"gsub", guarded<gsub>},
                                     {nullptr, nullptr}};
  luaL_setfuncs(L, kFunctions, 0);
}

}  // namespace spark::script
