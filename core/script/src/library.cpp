#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime.h"

// The pure library of all scripts. Lua's own, but: traversal by sorted key, a stable sort (Lua's picks its pivot by the
// clock), random numbers from the kernel's streams, no addresses in texts, nothing that depends on the garbage
// collector, no files, no clock, no load. Untrusted scripts get a part of it in which every function also pays for the
// size of its arguments; no metatables (they let a C function loop without end), no patterns (they take exponential
// time).
//
// The globals table of a state holds what every environment gets a copy of; no script reaches it.

namespace spark::script {

namespace {
constexpr const char* kStreamType = "random stream";

/// Lua's own function, kept in the registry by a function that replaces it.
int callOriginal(lua_State* L, const char* key) {
  lua_getfield(L, LUA_REGISTRYINDEX, key);
  const lua_CFunction original = lua_tocfunction(L, -1);
  lua_pop(L, 1);
  return original(L);
}

int nextSorted(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 2);
  pushNextKey(L, 1, lua_isnil(L, 2) ? 0 : 2);
  if (lua_isnil(L, -1)) return 1;
  lua_pushvalue(L, -1);
  lua_rawget(L, 1);
  return 2;
}

/// Upvalues: the sorted keys, how many were given out. A key whose value has gone meanwhile is left out.
int iterateKeys(lua_State* L) {
  lua_Integer i = lua_tointeger(L, lua_upvalueindex(2));
  int results = 0;
  while (results == 0) {
    lua_settop(L, 1);
    if (lua_rawgeti(L, lua_upvalueindex(1), ++i) == LUA_TNIL) {
      results = 1;
    } else {
      lua_pushvalue(L, -1);
      if (lua_rawget(L, 1) != LUA_TNIL) results = 2;
    }
  }
  lua_pushinteger(L, i);
  lua_replace(L, lua_upvalueindex(2));
  return results;
}

int pairsSorted(lua_State* L) {
  luaL_checkany(L, 1);
  if (luaL_getmetafield(L, 1, "__pairs") != LUA_TNIL) {
    lua_pushvalue(L, 1);
    lua_call(L, 1, 3);
    return 3;
  }
  if (!lua_istable(L, 1))
    throw Error("pairs expected a table, found a " + typeAt(L, 1) +
                (toNode(L, 1) ? ": use ipairs(node:children())" : ""));
  lua_settop(L, 1);
  pushSortedKeys(L, 1);
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, iterateKeys, 2);
  lua_pushvalue(L, 1);
  lua_pushnil(L);
  return 3;
}

int toText(lua_State* L) {
  luaL_checkany(L, 1);
  std::string out;
  appendText(L, 1, out);
  lua_pushlstring(L, out.data(), out.size());
  return 1;
}

int setMetatable(lua_State* L) {
  if (lua_istable(L, 2))
    for (const char* key : {"__gc", "__mode"}) {
      lua_pushstring(L, key);
      lua_rawget(L, 2);
      if (!lua_isnil(L, -1))
        throw Error(std::string("a metatable must not have ") + key +
                    ": the garbage collector's moment is not the same in every run");
      lua_pop(L, 1);
    }
  return callOriginal(L, "spark.setmetatable");
}

/// string.format without %p; %s shows tables and functions without their addresses.
int formatText(lua_State* L) {
  const std::string format(checkString(L, 1, "a format"));
  int argument = 1;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] != '%') continue;
    i = format.find_first_not_of("-+ #0123456789.", i + 1);
    if (i == std::string::npos) break;
    if (format[i] == '%') continue;
    ++argument;
    if (format[i] == 'p') throw Error("string.format knows no %p here: an address is not the same in every run");
    if (format[i] == 's' && argument <= lua_gettop(L) && !lua_isstring(L, argument)) {
      std::string text;
      appendText(L, argument, text);
      lua_pushlstring(L, text.data(), text.size());
      lua_replace(L, argument);
    }
  }
  return callOriginal(L, "spark.format");
}

/// string.rep, which would count to 2^63 for an empty string.
int repeatText(lua_State* L) {
  if (checkString(L, 1, "a text").empty() && (lua_isnoneornil(L, 3) || checkString(L, 3, "a separator").empty())) {
    luaL_checkinteger(L, 2);
    lua_pushliteral(L, "");
    return 1;
  }
  return callOriginal(L, "spark.rep");
}

/// True when the element at stack index `right` goes before the one at `left`, by the comparison at index 2 or by `<`.
bool goesBefore(lua_State* L, int right, int left) {
  if (lua_isnil(L, 2)) return lua_compare(L, right, left, LUA_OPLT);
  right = lua_absindex(L, right);
  left = lua_absindex(L, left);
  lua_pushvalue(L, 2);
  lua_pushvalue(L, right);
  lua_pushvalue(L, left);
  lua_call(L, 2, 1);
  const bool before = lua_toboolean(L, -1);
  lua_pop(L, 1);
  return before;
}

/// Merges the runs [low, middle) and [middle, high) of table `from` into `to`.
void merge(lua_State* L, int from, int to, lua_Integer low, lua_Integer middle, lua_Integer high) {
  lua_Integer left = low, right = middle;
  for (lua_Integer out = low; out < high; ++out) {
    bool takeRight = left == middle;
    if (!takeRight && right < high) {
      lua_rawgeti(L, from, left);
      lua_rawgeti(L, from, right);
      takeRight = goesBefore(L, -1, -2);
      lua_pop(L, 2);
    }
    lua_rawgeti(L, from, takeRight ? right++ : left++);
    lua_rawseti(L, to, out);
  }
}

/// table.sort as a stable merge sort.
int sortTable(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  if (!lua_isnoneornil(L, 2)) luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_settop(L, 2);
  const lua_Integer n = luaL_len(L, 1);
  luaL_argcheck(L, n < std::numeric_limits<int>::max(), 1, "array too big");
  int from = 3, to = 4;
  lua_createtable(L, static_cast<int>(std::max<lua_Integer>(n, 0)), 0);
  lua_createtable(L, static_cast<int>(std::max<lua_Integer>(n, 0)), 0);
  for (lua_Integer i = 1; i <= n; ++i) {
    lua_geti(L, 1, i);
    lua_rawseti(L, from, i);
  }
  for (lua_Integer width = 1; width < n; width *= 2, std::swap(from, to))
    for (lua_Integer low = 1; low <= n; low += 2 * width)
      merge(L, from, to, low, std::min(low + width, n + 1), std::min(low + 2 * width, n + 1));
  for (lua_Integer i = 1; i <= n; ++i) {
    lua_rawgeti(L, from, i);
    lua_seti(L, 1, i);
  }
  return 0;
}

/// An environment's random numbers. The owner is asked for its path at the first draw.
struct Stream {
  Ref<Leaf> owner;
  RandomStream numbers;
  bool keyed = false;
};

Stream& streamOf(lua_State* L) {
  auto& stream = *static_cast<Stream*>(lua_touserdata(L, lua_upvalueindex(1)));
  if (!stream.keyed && !stream.owner) throw Error("math.random has no stream: the script's node is gone");
  return stream;
}

int drawRandom(lua_State* L) {
  Stream& stream = streamOf(L);
  stream.keyed = true;
  if (lua_gettop(L) == 0) {
    lua_pushnumber(L, stream.numbers.uniform());
    return 1;
  }
  const lua_Integer first = luaL_checkinteger(L, 1);
  if (lua_gettop(L) == 1 && first == 0) {
    lua_pushinteger(L, static_cast<lua_Integer>(stream.numbers.bits()));
    return 1;
  }
  const lua_Integer low = lua_gettop(L) == 1 ? 1 : first, high = lua_gettop(L) == 1 ? first : luaL_checkinteger(L, 2);
  luaL_argcheck(L, low <= high, lua_gettop(L) == 1 ? 1 : 2, "interval is empty");
  const std::uint64_t range = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
  const std::uint64_t drawn = range == 0 ? stream.numbers.bits() : stream.numbers.below(range);
  lua_pushinteger(L, static_cast<lua_Integer>(static_cast<std::uint64_t>(low) + drawn));
  return 1;
}

int seedRandom(lua_State* L) {
  Stream& stream = streamOf(L);
  const lua_Number number = luaL_checknumber(L, 1);
  stream.numbers.seed(lua_isinteger(L, 1) ? static_cast<std::uint64_t>(lua_tointeger(L, 1))
                                          : std::bit_cast<std::uint64_t>(number));
  stream.keyed = true;
  return 0;
}

int freeStream(lua_State* L) {
  static_cast<Stream*>(lua_touserdata(L, 1))->~Stream();
  return 0;
}

/// Upvalue: the function of the library. Takes the size of the arguments off the budget first.
int callCharged(lua_State* L) {
  std::uint64_t cost = 0;
  for (int i = 1; i <= lua_gettop(L); ++i) {
    if (lua_type(L, i) == LUA_TSTRING) cost += lua_rawlen(L, i) / kBytesPerInstruction;
    if (lua_type(L, i) == LUA_TTABLE) cost += lua_rawlen(L, i);
  }
  State::of(L).charge(L, cost);
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

/// Elements that a function of the table library moves, compares or joins, as its arguments say.
struct Elements {
  static double length(lua_State* L) { return lua_istable(L, 1) ? static_cast<double>(lua_rawlen(L, 1)) : 0; }
  static double integer(lua_State* L, int index, double otherwise) {
    return lua_isinteger(L, index) ? static_cast<double>(lua_tointeger(L, index)) : otherwise;
  }
  static double concat(lua_State* L) {
    return 4 * (integer(L, 4, length(L)) - integer(L, 3, 1));
  }  // numbers become texts
  static double insert(lua_State* L) { return lua_gettop(L) == 3 ? length(L) - integer(L, 2, 1) : 0; }
  static double remove(lua_State* L) { return lua_gettop(L) == 2 ? length(L) - integer(L, 2, 1) : 0; }
  static double move(lua_State* L) { return integer(L, 3, 0) - integer(L, 2, 0); }
  static double unpack(lua_State* L) { return integer(L, 3, length(L)) - integer(L, 2, 1); }
  static double sort(lua_State* L) {
    return 4 * length(L) * std::log2(length(L) + 1);
  }  // a comparison takes as long as four moves
};

/// Upvalue: the function of the table library. Takes the elements that it works on off the budget first.
template <double (*Count)(lua_State*)>
int callTable(lua_State* L) {
  State::of(L).charge(L, static_cast<std::uint64_t>(std::clamp(Count(L), 0.0, 1e15)));
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

/// Replaces function `name` of the table on top of the stack, keeping the original in the registry as `key`.
void replace(lua_State* L, const char* name, const char* key, lua_CFunction function) {
  lua_getfield(L, -1, name);
  lua_setfield(L, LUA_REGISTRYINDEX, key);
  lua_pushcfunction(L, function);
  lua_setfield(L, -2, name);
}

void remove(lua_State* L, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    lua_pushnil(L);
    lua_setfield(L, -2, name);
  }
}

/// The table on top of the stack: only `names` stay.
void keepCharged(lua_State* L, std::initializer_list<const char*> names) {
  lua_newtable(L);
  for (const char* name : names) {
    if (lua_getfield(L, -2, name) == LUA_TFUNCTION) lua_pushcclosure(L, callCharged, 1);
    lua_setfield(L, -2, name);
  }
  lua_replace(L, -2);
}

void keepChargedLibrary(lua_State* L, const char* library, std::initializer_list<const char*> names) {
  lua_getfield(L, 1, library);
  keepCharged(L, names);
  lua_setfield(L, 2, library);
}

/// Replaces the globals by the part that untrusted scripts get.
void restrict(lua_State* L) {
  lua_settop(L, 0);
  lua_pushglobaltable(L);
  lua_pushvalue(L, 1);
  keepCharged(L, {"assert", "error", "ipairs", "next", "pairs", "pcall", "rawequal", "rawget", "rawlen", "rawset",
                  "select", "tonumber", "tostring", "type"});
  keepChargedLibrary(L, "string", {"byte", "char", "format", "len", "lower", "rep", "reverse", "sub", "upper"});
  keepChargedLibrary(L, "table", {"concat", "insert", "pack", "remove", "sort", "unpack"});
  keepChargedLibrary(L, "utf8", {"char", "charpattern", "codepoint", "codes", "len", "offset"});
  lua_getfield(L, 1, "math");
  lua_setfield(L, 2, "math");
  lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
  lua_settop(L, 0);
}

/// Pushes a copy of the table at `index`; tables in it are copied too, once deep.
void pushCopy(lua_State* L, int index, bool deep) {
  index = lua_absindex(L, index);
  lua_newtable(L);
  for (lua_pushnil(L); lua_next(L, index);) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    if (deep && lua_istable(L, -1)) {
      pushCopy(L, -1, false);
      lua_replace(L, -2);
    }
    lua_rawset(L, -4);
  }
}
}  // namespace

void appendText(lua_State* L, int index, std::string& out) {
  const bool plain = lua_isnoneornil(L, index) || lua_isboolean(L, index) || lua_isstring(L, index);
  if (!plain && luaL_getmetafield(L, index, "__tostring") == LUA_TNIL) {
    out += typeAt(L, index);
    return;
  }
  if (!plain) lua_pop(L, 1);
  std::size_t n = 0;
  const char* text = luaL_tolstring(L, index, &n);
  out.append(text, n);
  lua_pop(L, 1);
}

void openLibrary(lua_State* L, bool trusted) {
  constexpr luaL_Reg kLibraries[] = {{"_G", luaopen_base},     {"string", luaopen_string},
                                     {"table", luaopen_table}, {"math", luaopen_math},
                                     {"utf8", luaopen_utf8},   {"coroutine", luaopen_coroutine}};
  for (const luaL_Reg& library : kLibraries) {
    luaL_requiref(L, library.name, library.func, 1);
    lua_pop(L, 1);
  }
  lua_pushglobaltable(L);
  remove(L, {"_G", "collectgarbage", "dofile", "load", "loadfile", "print", "warn"});
  replace(L, "setmetatable", "spark.setmetatable", guarded<setMetatable>);
  constexpr luaL_Reg kBase[] = {{"next", guarded<nextSorted>},
                                {"pairs", guarded<pairsSorted>},
                                {"tostring", guarded<toText>},
                                {nullptr, nullptr}};
  luaL_setfuncs(L, kBase, 0);
  lua_getfield(L, -1, "string");
  remove(L, {"dump"});
  replace(L, "format", "spark.format", guarded<formatText>);
  replace(L, "rep", "spark.rep", guarded<repeatText>);
  openPatterns(L);
  lua_pop(L, 1);
  lua_getfield(L, -1, "table");
  lua_pushcfunction(L, guarded<sortTable>);
  lua_setfield(L, -2, "sort");
  constexpr luaL_Reg kTable[] = {{"concat", callTable<Elements::concat>}, {"insert", callTable<Elements::insert>},
                                 {"move", callTable<Elements::move>},     {"remove", callTable<Elements::remove>},
                                 {"sort", callTable<Elements::sort>},     {"unpack", callTable<Elements::unpack>}};
  for (const luaL_Reg& f : kTable) {
    if (!trusted) break;  // callCharged makes them pay
    lua_getfield(L, -1, f.name);
    lua_pushcclosure(L, f.func, 1);
    lua_setfield(L, -2, f.name);
  }
  lua_pop(L, 1);
  lua_getfield(L, -1, "utf8");
  for (const char* name : {"codepoint", "len", "offset"}) {
    if (!trusted) break;
    lua_getfield(L, -1, name);
    lua_pushcclosure(L, callCharged, 1);
    lua_setfield(L, -2, name);
  }
  lua_pop(L, 2);
  if (!trusted) restrict(L);

  luaL_newmetatable(L, kStreamType);
  lua_pushcfunction(L, freeStream);
  lua_setfield(L, -2, "__gc");
  lua_pop(L, 1);
  // Texts find their methods in a table of their own, which no script can change.
  lua_pushliteral(L, "");
  lua_getmetatable(L, -1);
  lua_getglobal(L, "string");
  pushCopy(L, -1, false);
  lua_setfield(L, -3, "__index");
  lua_pop(L, 1);
  lua_pushliteral(L, "string");
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 2);
}

void pushEnvironment(lua_State* L, Leaf& node, bool config) {
  lua_pushglobaltable(L);
  pushCopy(L, -1, true);
  lua_remove(L, -2);
  lua_pushvalue(L, -1);
  lua_setfield(L, -2, "_G");

  lua_getfield(L, -1, "math");
  new (lua_newuserdatauv(L, sizeof(Stream), 0)) Stream{Ref<Leaf>(&node), RandomStream(node, "script")};
  luaL_setmetatable(L, kStreamType);
  lua_pushvalue(L, -1);
  lua_pushcclosure(L, guarded<drawRandom>, 1);
  lua_setfield(L, -3, "random");
  lua_pushcclosure(L, guarded<seedRandom>, 1);
  lua_setfield(L, -2, "randomseed");
  lua_pop(L, 1);

  addGlobals(L, node, config);
}

}  // namespace spark::script
