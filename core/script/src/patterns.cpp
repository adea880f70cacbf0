#include <algorithm>
#include <cctype>
#include <cstring>

#include "runtime.h"

// find, match, gmatch and gsub of Lua 5.4 (reference manual, section 6.4.1). Lua's own run as one instruction however
// long they take, and a pattern such as ".-.-.-b" takes exponential time: these pay a unit of the budget for each
// comparison.

namespace spark::script {

namespace patterns {
constexpr int kMostCaptures = 32;
constexpr int kDeepest = 200;                         // nested calls of a pattern
constexpr std::ptrdiff_t kOpen = -1, kPosition = -2;  // instead of a capture's length

/// One attempt to match a pattern, and what it captured.
class Matcher {
 public:
  Matcher(lua_State* L, std::string_view subject, std::string_view pattern)
      : L_(L),
        state_(State::of(L)),
        begin_(subject.data()),
        end_(begin_ + subject.size()),
        patternEnd_(pattern.data() + pattern.size()) {}

  /// The end of the match of `pattern` at `at`, nullptr when there is none.
  const char* start(const char* at, const char* pattern) {
    level_ = 0;
    depth_ = kDeepest;
    return match(at, pattern);
  }
  const char* begin() const { return begin_; }
  const char* end() const { return end_; }

  /// Pushes capture i; without captures the first is the whole match.
  void push(int i, const char* from, const char* to) const {
    if (i >= level_) {
      if (i != 0) throw Error("invalid capture index %" + std::to_string(i + 1));
      lua_pushlstring(L_, from, static_cast<std::size_t>(to - from));
    } else if (captures_[i].length == kPosition) {
      lua_pushinteger(L_, captures_[i].begin - begin_ + 1);
    } else if (captures_[i].length == kOpen) {
      throw Error("unfinished capture");
    } else {
      lua_pushlstring(L_, captures_[i].begin, static_cast<std::size_t>(captures_[i].length));
    }
  }
  /// Pushes all captures, or the whole match when `from` is given and there are none. Returns how many.
  int pushAll(const char* from, const char* to) const {
    const int n = level_ == 0 && from ? 1 : level_;
    luaL_checkstack(L_, n, "too many captures");
    for (int i = 0; i < n; ++i) push(i, from, to);
    return n;
  }

 private:
  struct Capture {
    const char* begin;
    std::ptrdiff_t length;
  };

  void pay() { state_.charge(L_); }

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

  /// Behind the single character class that begins at p.
  const char* classEnd(const char* p) const {
    if (*p++ == '%') {
      if (p == patternEnd_) throw Error("malformed pattern (ends with '%')");
      return p + 1;
    }
    if (p[-1] != '[') return p;
    if (p < patternEnd_ && *p == '^') ++p;
    do {  // a ] that comes first is one of the set
      if (p == patternEnd_) throw Error("malformed pattern (missing ']')");
      if (*p++ == '%') {
        if (p == patternEnd_) throw Error("malformed pattern (missing ']')");
        ++p;
      }
    } while (p == patternEnd_ || *p != ']');
    return p + 1;
  }

  /// `p` at the [, `last` at the ].
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

  bool single(const char* at, const char* p, const char* behind) {
    pay();
    if (at >= end_) return false;
    switch (*p) {
      case '.':
        return true;
      case '%':
        return inClass(byte(at), byte(p + 1));
      case '[':
        return inSet(byte(at), p, behind - 1);
      default:
        return byte(p) == byte(at);
    }
  }

  const char* balanced(const char* at, const char* p) {
    if (p + 1 >= patternEnd_) throw Error("malformed pattern (missing arguments to '%b')");
    if (at >= end_ || *at != p[0]) return nullptr;
    int open = 1;
    for (const char* s = at + 1; s < end_; ++s) {
      pay();
      if (*s == p[1]) {
        if (--open == 0) return s + 1;
      } else if (*s == p[0]) {
        ++open;
      }
    }
    return nullptr;
  }

  const char* most(const char* at, const char* p, const char* behind) {
    std::ptrdiff_t n = 0;
    while (single(at + n, p, behind)) ++n;
    for (; n >= 0; --n)
      if (const char* to = match(at + n, behind + 1)) return to;
    return nullptr;
  }

  const char* least(const char* at, const char* p, const char* behind) {
    for (;; ++at) {
      if (const char* to = match(at, behind + 1)) return to;
      if (!single(at, p, behind)) return nullptr;
    }
  }

  const char* open(const char* at, const char* p, std::ptrdiff_t kind) {
    if (level_ >= kMostCaptures) throw Error("too many captures");
    captures_[level_++] = {at, kind};
    const char* to = match(at, p);
    if (!to) --level_;
    return to;
  }

  const char* close(const char* at, const char* p) {
    int i = level_ - 1;
    while (i >= 0 && captures_[i].length != kOpen) --i;
    if (i < 0) throw Error("invalid pattern capture");
    captures_[i].length = at - captures_[i].begin;
    const char* to = match(at, p);
    if (!to) captures_[i].length = kOpen;
    return to;
  }

  const char* again(const char* at, int digit) {
    const int i = digit - '1';
    if (i < 0 || i >= level_ || captures_[i].length == kOpen)
      throw Error("invalid capture index %" + std::to_string(i + 1));
    if (captures_[i].length == kPosition) return nullptr;  // a place is no text
    const auto length = static_cast<std::size_t>(captures_[i].length);
    if (static_cast<std::size_t>(end_ - at) < length) return nullptr;
    state_.charge(L_, length / kBytesPerInstruction);
    if (std::memcmp(captures_[i].begin, at, length) != 0) return nullptr;
    return at + length;
  }

  bool frontier(const char* at, const char* p, const char* behind) {
    const int before = at == begin_ ? 0 : byte(at - 1), here = at < end_ ? byte(at) : 0;
    return !inSet(before, p, behind - 1) && inSet(here, p, behind - 1);
  }

  const char* match(const char* at, const char* p) {
    struct Level {
      int& depth;
      explicit Level(int& d) : depth(d) {
        if (depth-- == 0) throw Error("pattern too complex");
      }
      ~Level() { ++depth; }
    } level(depth_);
    for (;;) {
      pay();
      if (p == patternEnd_) return at;
      switch (*p) {
        case '(':
          return p + 1 < patternEnd_ && p[1] == ')' ? open(at, p + 2, kPosition) : open(at, p + 1, kOpen);
        case ')':
          return close(at, p + 1);
        case '$':
          if (p + 1 == patternEnd_) return at == end_ ? at : nullptr;
          break;
        case '%':
          if (p + 1 == patternEnd_) break;
          if (p[1] == 'b') {
            at = balanced(at, p + 2);
            if (!at) return nullptr;
            p += 4;
            continue;
          }
          if (p[1] == 'f') {
            p += 2;
            if (p == patternEnd_ || *p != '[') throw Error("missing '[' after '%f' in pattern");
            const char* behind = classEnd(p);
            if (!frontier(at, p, behind)) return nullptr;
            p = behind;
            continue;
          }
          if (std::isdigit(byte(p + 1))) {
            at = again(at, byte(p + 1));
            if (!at) return nullptr;
            p += 2;
            continue;
          }
          break;
        default:
          break;
      }
      const char* behind = classEnd(p);
      const char suffix = behind < patternEnd_ ? *behind : '\0';
      if (suffix == '*') return most(at, p, behind);
      if (suffix == '-') return least(at, p, behind);
      if (suffix == '+') return single(at, p, behind) ? most(at + 1, p, behind) : nullptr;
      const bool matches = single(at, p, behind);
      if (suffix == '?') {
        if (matches)
          if (const char* to = match(at + 1, behind + 1)) return to;
        p = behind + 1;
        continue;
      }
      if (!matches) return nullptr;
      ++at;
      p = behind;
    }
  }

  lua_State* L_;
  State& state_;
  const char *begin_, *end_, *patternEnd_;
  int level_ = 0, depth_ = kDeepest;
  std::array<Capture, kMostCaptures> captures_;
};

static std::string_view text(lua_State* L, int index) {
  std::size_t n = 0;
  const char* s = luaL_checklstring(L, index, &n);
  return {s, n};
}

/// Where the optional argument says that a search begins, from 0; beyond the end: one more than the length.
static std::size_t beginAt(lua_State* L, int index, std::size_t length) {
  const lua_Integer at = luaL_optinteger(L, index, 1);
  const auto n = static_cast<lua_Integer>(length);
  if (at > 0) return static_cast<std::size_t>(std::min(at - 1, n + 1));
  if (at == 0 || at < -n) return 0;
  return static_cast<std::size_t>(n + at);
}

/// Where `what` begins at or behind `from`; npos when it does not.
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

static int search(lua_State* L, bool find) {
  const std::string_view subject = text(L, 1), pattern = text(L, 2);
  const std::size_t from = beginAt(L, 3, subject.size());
  if (from > subject.size()) {
    luaL_pushfail(L);
    return 1;
  }
  if (find && (lua_toboolean(L, 4) || pattern.find_first_of("^$*+?.([%-") == std::string_view::npos)) {
    const std::size_t at = findPlain(L, subject, pattern, from);
    if (at == std::string_view::npos) {
      luaL_pushfail(L);
      return 1;
    }
    lua_pushinteger(L, static_cast<lua_Integer>(at + 1));
    lua_pushinteger(L, static_cast<lua_Integer>(at + pattern.size()));
    return 2;
  }
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

/// Upvalues: subject, pattern, where to go on (from 0), where the last match ended (-1: there was none).
static int nextMatch(lua_State* L) {
  const std::string_view subject = text(L, lua_upvalueindex(1)), pattern = text(L, lua_upvalueindex(2));
  Matcher m(L, subject, pattern);
  const lua_Integer last = lua_tointeger(L, lua_upvalueindex(4));
  for (const char* at = m.begin() + lua_tointeger(L, lua_upvalueindex(3)); at <= m.end(); ++at) {
    const char* to = m.start(at, pattern.data());
    if (!to || to - m.begin() == last) continue;
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
  const std::size_t from = beginAt(L, 3, subject.size());
  lua_settop(L, 2);
  lua_pushinteger(L, static_cast<lua_Integer>(from));
  lua_pushinteger(L, -1);
  lua_pushcclosure(L, guarded<nextMatch>, 4);
  return 1;
}

/// Appends a replacement text with its %0..%9.
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
      std::size_t n = 0;
      const char* s = luaL_tolstring(L, -1, &n);
      out.append(s, n);
      lua_pop(L, 2);
    } else {
      throw Error("invalid use of '%' in replacement string");
    }
  }
}

/// Appends what replaces a match. False: it stays as it was.
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
  if (!lua_isstring(L, -1)) throw Error(std::string("invalid replacement value (a ") + luaL_typename(L, -1) + ")");
  std::size_t n = 0;
  const char* s = lua_tolstring(L, -1, &n);
  out.append(s, n);
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
    lua_pushlstring(L, out.data(), out.size());
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
