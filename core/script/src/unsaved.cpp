#include "unsaved.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace spark::script {

// Lua has no access to its compiled functions but lua_dump(), whose format is that of Lua 5.4: a header, then for each
// function its instructions, constants, the places of its upvalues, the functions in it, and names for debugging.
static_assert(LUA_VERSION_NUM == 504, "unsaved.cpp reads compiled functions of Lua 5.4");

namespace {
/// Where a function finds an upvalue: among the registers or the upvalues of the function around it.
struct Upvalue {
  bool inRegister = false;
  std::size_t index = 0;
};

/// A compiled function.
struct Compiled {
  int line = 0;  ///< where it is defined
  std::vector<std::uint32_t> code;
  std::vector<std::string> constants;  ///< the texts; "" for others
  std::vector<Upvalue> upvalues;
  std::vector<Compiled> inner;
  std::vector<int> lines;  ///< of each instruction
};

/// Reads what lua_dump() wrote.
class DumpReader {
 public:
  explicit DumpReader(std::string_view dump) : dump_(dump) {}
  Compiled read() {
    // Signature, version, format, six bytes against conversions, sizes of three types, an integer, a number; the number
    // of upvalues.
    skip(4 + 1 + 1 + 6 + 3 + sizeof(lua_Integer) + sizeof(lua_Number) + 1);
    return function();
  }

 private:
  void skip(std::size_t bytes) { at_ += bytes; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(dump_.at(at_++)); }
  std::size_t size() {
    std::size_t n = 0;
    for (;;) {
      const std::uint8_t b = byte();
      n = n << 7 | (b & 0x7f);
      if (b & 0x80) return n;
    }
  }
  std::string text() {
    const std::size_t n = size();  // one more than the length; 0: none
    if (n == 0) return {};
    std::string out(dump_.substr(at_, n - 1));
    skip(n - 1);
    return out;
  }

  Compiled function() {
    Compiled f;
    text();  // the file
    f.line = static_cast<int>(size());
    size();   // the last line
    skip(3);  // parameters, varargs, registers
    f.code.resize(size());
    for (std::uint32_t& instruction : f.code) {
      std::memcpy(&instruction, dump_.substr(at_, sizeof instruction).data(), sizeof instruction);
      skip(sizeof instruction);
    }
    f.constants.resize(size());
    for (std::string& c : f.constants) constant(c);
    f.upvalues.resize(size());
    for (Upvalue& u : f.upvalues) {
      u.inRegister = byte() != 0;
      u.index = byte();
      skip(1);
    }
    f.inner.resize(size());
    for (Compiled& c : f.inner) c = function();
    readLines(f);
    for (std::size_t n = size(); n > 0; --n) text(), size(), size();  // locals and where they live
    for (std::size_t n = size(); n > 0; --n) text();                  // names of upvalues
    return f;
  }
  void constant(std::string& out) {
    switch (const int type = byte(); type & 0x0f) {
      case LUA_TNUMBER:
        return skip(type == LUA_TNUMBER ? sizeof(lua_Integer) : sizeof(lua_Number));
      case LUA_TSTRING:
        out = text();
        return;
      default:
        return;  // nil, false, true
    }
  }
  void readLines(Compiled& f) {
    constexpr int kElsewhere = -0x80;  // the line is in the second list
    std::vector<int> steps(size());
    for (int& s : steps) s = (byte() ^ 0x80) - 0x80;  // a signed byte
    std::vector<std::pair<std::size_t, int>> absolute(size());
    for (auto& [pc, line] : absolute) pc = size(), line = static_cast<int>(size());
    int line = f.line;
    for (std::size_t pc = 0; pc < steps.size(); ++pc) {
      if (steps[pc] != kElsewhere) line += steps[pc];
      for (const auto& [at, known] : absolute)
        if (at == pc) line = known;
      f.lines.push_back(line);
    }
  }

  std::string_view dump_;
  std::size_t at_ = 0;
};

/// The instructions that matter, of Lua 5.4's lopcodes.h.
enum class Op : std::uint8_t {
  move = 0,
  loadNil = 8,
  getUpvalue = 9,
  setUpvalue = 10,
  getGlobal = 11,
  getTable = 12,
  getInteger = 13,
  getField = 14,
  setGlobal = 15,
  setTable = 16,
  setInteger = 17,
  setField = 18,
  self = 20,
  mmbin = 46,
  mmbinK = 48,
  close = 54,
  testSet = 67,
  call = 68,
  tailCall = 69,
  return1 = 72,
  forLoop = 73,
  forPrepare = 74,
  forInPrepare = 75,
  forInCall = 76,
  forInLoop = 77,
  setList = 78,
  varargs = 80,
  varargsPrepare = 81,
  extra = 82,
};

/// True if an instruction changes no register.
bool changesNone(Op op) {
  return (op >= Op::mmbin && op <= Op::mmbinK) || (op >= Op::close && op < Op::testSet) ||
         (op > Op::tailCall && op <= Op::return1) || op == Op::setList || op == Op::varargsPrepare || op == Op::extra;
}

/// Goes through a function that exists, and those that it reaches.
class Search {
 public:
  Search(lua_State* L, const std::set<const void*>& saved) : L_(L), saved_(saved) {}

  void function(int index) {
    index = lua_absindex(L_, index);
    if (lua_iscfunction(L_, index) || !seen_.insert(lua_topointer(L_, index)).second) return;
    luaL_checkstack(L_, 8, "functions that call each other");
    lua_pushvalue(L_, index);
    std::string dump;
    lua_dump(
        L_,
        [](lua_State*, const void* data, std::size_t size, void* out) {
          static_cast<std::string*>(out)->append(static_cast<const char*>(data), size);
          return 0;
        },
        &dump, 0);
    lua_Debug about{};
    lua_getinfo(L_, ">S", &about);
    const Compiled f = DumpReader(dump).read();
    const int outer = std::exchange(function_, index);
    const std::string file = std::exchange(file_, about.short_src);
    std::vector<std::optional<int>> upvalues(f.upvalues.size());
    for (std::size_t i = 0; i < upvalues.size(); ++i) upvalues[i] = static_cast<int>(i) + 1;
    search(f, upvalues);
    function_ = outer;
    file_ = file;
  }
  std::vector<std::string> found;

 private:
  /// `upvalues`: for each one of `f` the number of that of the function at function_; none for a local of that.
  void search(const Compiled& f, const std::vector<std::optional<int>>& upvalues) {
    origin_.assign(256, "");
    for (std::size_t pc = 0; pc < f.code.size(); ++pc) {
      line_ = pc < f.lines.size() ? f.lines[pc] : f.line;
      instruction(f, f.code[pc], upvalues);
    }
    for (const Compiled& inner : f.inner) {
      std::vector<std::optional<int>> of;
      for (const Upvalue& u : inner.upvalues)
        of.push_back(u.inRegister || u.index >= upvalues.size() ? std::nullopt : upvalues[u.index]);
      search(inner, of);
    }
  }

  void instruction(const Compiled& f, std::uint32_t code, const std::vector<std::optional<int>>& upvalues) {
    const auto op = static_cast<Op>(code & 0x7f);
    const unsigned a = code >> 7 & 0xff, b = code >> 16 & 0xff, c = code >> 24 & 0xff;
    const auto upvalue = [&](unsigned i) { return i < upvalues.size() ? upvalues[i] : std::nullopt; };
    const auto constant = [&](unsigned i) { return i < f.constants.size() ? f.constants[i] : std::string(); };
    switch (op) {
      case Op::move:
        origin_[a] = origin_[b];
        return;
      case Op::getUpvalue:
        origin_[a] = upvalue(b) ? table(*upvalue(b)) : "";
        return;
      case Op::setUpvalue:
        if (const auto n = upvalue(b)) report(fmt::format("sets the local '{}' outside of it", name(*n)));
        return;
      case Op::getGlobal:
        origin_[a] = upvalue(b) ? field(*upvalue(b), constant(c)) : "";
        return;
      case Op::getTable:
      case Op::getInteger:
      case Op::getField:
        origin_[a] = origin_[b];
        return;
      case Op::setGlobal:
        if (const auto n = upvalue(a)) writeGlobal(*n, constant(b));
        return;
      case Op::setTable:
      case Op::setInteger:
      case Op::setField:
        if (!origin_[a].empty()) report(fmt::format("writes into {}", origin_[a]));
        return;
      case Op::loadNil:
        for (unsigned r = a; r <= a + b && r < origin_.size(); ++r) origin_[r].clear();
        return;
      case Op::self:
        if (a + 1 < origin_.size()) origin_[a + 1] = origin_[b];
        origin_[a].clear();
        return;
      case Op::call:
      case Op::tailCall:
      case Op::forInCall:
      case Op::varargs:
        for (unsigned r = op == Op::forInCall ? a + 4 : a; r < origin_.size(); ++r) origin_[r].clear();
        return;
      case Op::forLoop:
      case Op::forPrepare:
      case Op::forInPrepare:
      case Op::forInLoop:
        for (unsigned r = a; r <= a + 4 && r < origin_.size(); ++r) origin_[r].clear();
        return;
      default:
        if (!changesNone(op)) origin_[a].clear();
    }
  }

  /// Writes to a field of an upvalue: to a global if it is the environment.
  void writeGlobal(int number, const std::string& key) {
    if (name(number) != "_ENV") {
      if (const std::string t = table(number); !t.empty()) report(fmt::format("writes into {}", t));
    } else if (key != "state") {
      report(fmt::format("sets the global '{}'", key));
    }
  }

  /// What the upvalue is for messages if it is a table that is not saved, else "". A function is searched.
  std::string table(int number) {
    lua_getupvalue(L_, function_, number);
    std::string out = look(fmt::format("the table in the local '{}' outside of it", name(number)));
    lua_pop(L_, 1);
    return out;
  }
  /// The same for a field of an upvalue, which is a global if that is the environment.
  std::string field(int number, const std::string& key) {
    if (name(number) != "_ENV") return table(number);
    lua_getupvalue(L_, function_, number);
    std::string out;
    if (lua_istable(L_, -1)) {
      lua_pushlstring(L_, key.data(), key.size());
      lua_rawget(L_, -2);
      out = look(fmt::format("the table in the global '{}'", key));
      lua_pop(L_, 1);
    }
    lua_pop(L_, 1);
    return out;
  }
  /// The same for the value on top of the stack.
  std::string look(const std::string& what) {
    if (lua_isfunction(L_, -1)) {
      const auto kept = origin_;
      const int line = line_;
      function(-1);
      origin_ = kept, line_ = line;
    }
    return lua_istable(L_, -1) && !saved_.contains(lua_topointer(L_, -1)) ? what : "";
  }

  std::string name(int number) {
    const char* const text = lua_getupvalue(L_, function_, number);
    if (text) lua_pop(L_, 1);
    return text ? text : "";
  }
  void report(const std::string& what) {
    std::string line = fmt::format("{}:{}: {}", file_, line_, what);
    if (reported_.insert(line).second) found.push_back(std::move(line));
  }

  lua_State* L_;
  const std::set<const void*>& saved_;
  int function_ = 0;  ///< index on the stack of the function that is searched
  int line_ = 0;
  std::string file_;
  std::vector<std::string> origin_;  ///< of each register: what holds the table in it; "" for saved or unknown ones
  std::set<const void*> seen_;
  std::set<std::string> reported_;
};
}  // namespace

std::vector<std::string> unsavedWrites(lua_State* L, int index, const std::set<const void*>& saved) {
  Search search(L, saved);
  search.function(index);
  return std::move(search.found);
}

}  // namespace spark::script
