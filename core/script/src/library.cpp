#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "environment.h"
#include "memory.h"
#include "nodes.h"
#include "runtime.h"
#include "spark/error.h"
#include "spark/leaf.h"
#include "state.h"
#include "values.h"

// The library of all scripts. It is Lua's own, made deterministic: traversal in order of key, a stable sort (Lua's
// depends on the clock), random numbers from the kernel's streams, no addresses in texts, nothing that depends on the
// garbage collector, no files, no clock, no load. Untrusted scripts get a part of it, whose functions charge for the
// size of their arguments. That part has no metatables, which let a C function loop forever, and no patterns, which
// take exponential time.
//
// The table of globals of a state is the model: every environment gets a copy, and scripts cannot reach the model.

namespace spark::script {

namespace {
constexpr const char* kStreamType = "random stream";

/// Calls Lua's own function, which replace() has kept in the registry.
int callOriginal(lua_State* L, const char* key) {
  lua_getfield(L, LUA_REGISTRYINDEX, key);
  const lua_CFunction original = lua_tocfunction(L, -1);
  lua_pop(L, 1);
  return original(L);
}

/// next in order of key.
int nextSorted(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 2);
  pushNextKey(L, 1, lua_isnil(L, 2) ? 0 : 2);
  if (lua_isnil(L, -1)) return 1;
  lua_pushvalue(L, -1);
  lua_rawget(L, 1);
  return 2;
}

/// The iterator of pairs. Upvalues: the sorted keys, and the number of keys so far. A key whose value has been removed
/// meanwhile is skipped.
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

/// pairs in order of key.
int pairsSorted(lua_State* L) {
  luaL_checkany(L, 1);
  if (luaL_getmetafield(L, 1, "__pairs") != LUA_TNIL) {
    lua_pushvalue(L, 1);
    lua_call(L, 1, 3);
    return 3;
  }
  if (!lua_istable(L, 1))
    throw Error(fmt::format("pairs expected a table, found a {}{}", typeAt(L, 1),
                            toNode(L, 1) ? ": use ipairs(node:children())" : ""));
  lua_settop(L, 1);
  pushSortedKeys(L, 1);
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, iterateKeys, 2);
  lua_pushvalue(L, 1);
  lua_pushnil(L);
  return 3;
}

/// tostring without addresses.
int toText(lua_State* L) {
  luaL_checkany(L, 1);
  std::string out;
  appendText(L, 1, out);
  pushText(L, out);
  return 1;
}

/// setmetatable without fields that depend on the garbage collector.
int setMetatable(lua_State* L) {
  if (lua_istable(L, 2))
    for (const char* key : {"__gc", "__mode"}) {
      lua_pushstring(L, key);
      lua_rawget(L, 2);
      if (!lua_isnil(L, -1))
        throw Error(fmt::format(
            "a metatable must not have {}: the garbage collector's moment is not the same in every run", key));
      lua_pop(L, 1);
    }
  return callOriginal(L, "spark.setmetatable");
}

/// string.format without %p; %s shows tables and functions without their addresses.
int formatText(lua_State* L) {
  const std::string format(checkString(L, 1, "a format"));
  // Replace the arguments of %s that have no text of their own.
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
      pushText(L, text);
      lua_replace(L, argument);
    }
  }
  return callOriginal(L, "spark.format");
}

/// string.rep, which for an empty string would count up to 2^63.
int repeatText(lua_State* L) {
  if (checkString(L, 1, "a text").empty() && (lua_isnoneornil(L, 3) || checkString(L, 3, "a separator").empty())) {
    luaL_checkinteger(L, 2);
    lua_pushliteral(L, "");
    return 1;
  }
  return callOriginal(L, "spark.rep");
}

/// True if the element at stack index `right` is less than the one at `left`, by the comparison at index 2 or by `<`.
bool isLess(lua_State* L, int right, int left) {
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
      takeRight = isLess(L, -1, -2);
      lua_pop(L, 2);
    }
    lua_rawgeti(L, from, takeRight ? right++ : left++);
    lua_rawseti(L, to, out);
  }
}

/// table.sort as a stable merge sort, bottom up.
int sortTable(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  if (!lua_isnoneornil(L, 2)) luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_settop(L, 2);
  const lua_Integer n = luaL_len(L, 1);
  luaL_argcheck(L, n < std::numeric_limits<int>::max(), 1, "array too big");
  // Two tables at indices 3 and 4, of which one is merged into the other.
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

/// The stream of a function, which is its upvalue.
Stream& streamOf(lua_State* L) {
  auto& stream = *static_cast<Stream*>(lua_touserdata(L, lua_upvalueindex(1)));
  if (!stream.seeded && !stream.owner) throw Error("math.random has no stream: the script's node is gone");
  return stream;
}

/// math.random. As Lua's: no argument for a float, 0 for all bits, else one limit or two.
int drawRandom(lua_State* L) {
  Stream& stream = streamOf(L);
  stream.seeded = true;
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
  // Unsigned, because the range may be up to 2^64, which becomes 0.
  const std::uint64_t range = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
  const std::uint64_t drawn = range == 0 ? stream.numbers.bits() : stream.numbers.below(range);
  const std::uint64_t chosen = static_cast<std::uint64_t>(low) + drawn;
  lua_pushinteger(L, static_cast<lua_Integer>(chosen));
  return 1;
}

/// math.randomseed.
int seedRandom(lua_State* L) {
  Stream& stream = streamOf(L);
  const lua_Number number = luaL_checknumber(L, 1);
  stream.numbers.seed(lua_isinteger(L, 1) ? static_cast<std::uint64_t>(lua_tointeger(L, 1))
                                          : std::bit_cast<std::uint64_t>(number));
  stream.seeded = true;
  return 0;
}

int freeStream(lua_State* L) {
  static_cast<Stream*>(lua_touserdata(L, 1))->~Stream();
  return 0;
}

/// Charges for the size of the arguments, then calls the function of the library that is its upvalue.
int callCharged(lua_State* L) {
  std::uint64_t cost = 0;
  for (int i = 1; i <= lua_gettop(L); ++i) {
    if (lua_type(L, i) == LUA_TSTRING) cost += lua_rawlen(L, i) / kBytesPerInstruction;
    if (lua_type(L, i) == LUA_TTABLE) cost += lua_rawlen(L, i);
  }
  State::of(L).charge(L, cost);
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

/// The number of elements that a function of the table library moves, compares or joins, computed from its arguments.
struct Elements {
  static double length(lua_State* L) { return lua_istable(L, 1) ? static_cast<double>(lua_rawlen(L, 1)) : 0; }
  static double integer(lua_State* L, int index, double otherwise) {
    return lua_isinteger(L, index) ? static_cast<double>(lua_tointeger(L, index)) : otherwise;
  }
  /// A number that becomes text costs as much as four moves.
  static double concat(lua_State* L) { return 4 * (integer(L, 4, length(L)) - integer(L, 3, 1)); }
  static double insert(lua_State* L) { return lua_gettop(L) == 3 ? length(L) - integer(L, 2, 1) : 0; }
  static double remove(lua_State* L) { return lua_gettop(L) == 2 ? length(L) - integer(L, 2, 1) : 0; }
  static double move(lua_State* L) { return integer(L, 3, 0) - integer(L, 2, 0); }
  static double unpack(lua_State* L) { return integer(L, 3, length(L)) - integer(L, 2, 1); }
  /// A comparison costs as much as four moves.
  static double sort(lua_State* L) { return 4 * length(L) * std::log2(length(L) + 1); }
};

/// Charges for the elements, then calls the function of the table library that is its upvalue.
template <double (*Count)(lua_State*)>
int callTable(lua_State* L) {
  State::of(L).charge(L, static_cast<std::uint64_t>(std::clamp(Count(L), 0.0, 1e15)));
  return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

/// Replaces function `name` of the table on top of the stack. callOriginal() finds the old one by `key`.
void replace(lua_State* L, const char* name, const char* key, lua_CFunction function) {
  lua_getfield(L, -1, name);
  lua_setfield(L, LUA_REGISTRYINDEX, key);
  lua_pushcfunction(L, function);
  lua_setfield(L, -2, name);
}

/// Removes entries of the table on top of the stack.
void remove(lua_State* L, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    lua_pushnil(L);
    lua_setfield(L, -2, name);
  }
}

/// Replaces the table on top of the stack by one that has only `names`, whose functions charge.
void keepCharged(lua_State* L, std::initializer_list<const char*> names) {
  lua_newtable(L);
  for (const char* name : names) {
    if (lua_getfield(L, -2, name) == LUA_TFUNCTION) lua_pushcclosure(L, callCharged, 1);
    lua_setfield(L, -2, name);
  }
  lua_replace(L, -2);
}

/// Copies a library from the globals at index 1 to those at index 2, with `names` only.
void keepChargedLibrary(lua_State* L, const char* library, std::initializer_list<const char*> names) {
  lua_getfield(L, 1, library);
  keepCharged(L, names);
  lua_setfield(L, 2, library);
}

/// Replaces the globals by the part for untrusted scripts.
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

/// Pushes a copy of the table at `index`. `deep`: tables in it are copied too, but not tables in these.
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

void openLibrary(lua_State* L, bool trusted) {
  constexpr luaL_Reg kLibraries[] = {{"_G", luaopen_base},     {"string", luaopen_string},
                                     {"table", luaopen_table}, {"math", luaopen_math},
                                     {"utf8", luaopen_utf8},   {"coroutine", luaopen_coroutine}};
  for (const luaL_Reg& library : kLibraries) {
    luaL_requiref(L, library.name, library.func, 1);
    lua_pop(L, 1);
  }

  // Functions that are not deterministic are removed or replaced.
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

  // Functions whose work depends on their arguments charge for it. In an untrusted state restrict() wraps all
  // functions.
  constexpr luaL_Reg kTable[] = {{"concat", callTable<Elements::concat>}, {"insert", callTable<Elements::insert>},
                                 {"move", callTable<Elements::move>},     {"remove", callTable<Elements::remove>},
                                 {"sort", callTable<Elements::sort>},     {"unpack", callTable<Elements::unpack>}};
  for (const luaL_Reg& f : kTable) {
    if (!trusted) break;
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

  // The metatable of random streams.
  luaL_newmetatable(L, kStreamType);
  lua_pushcfunction(L, freeStream);
  lua_setfield(L, -2, "__gc");
  lua_pop(L, 1);
  // The methods of strings are in a table of their own, which scripts cannot change.
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

  const int environment = lua_gettop(L);
  lua_newtable(L);
  lua_setfield(L, environment, "state");
  // Each environment has its own random numbers.
  lua_getfield(L, -1, "math");
  new (lua_newuserdatauv(L, sizeof(Stream), 0)) Stream{Ref<Leaf>(&node), RandomStream(node, "script")};
  luaL_setmetatable(L, kStreamType);
  State::of(L).runtime().memory.add(L, node, environment);
  lua_pushvalue(L, -1);
  lua_pushcclosure(L, guarded<drawRandom>, 1);
  lua_setfield(L, -3, "random");
  lua_pushcclosure(L, guarded<seedRandom>, 1);
  lua_setfield(L, -2, "randomseed");
  lua_pop(L, 1);

  addGlobals(L, node, config);
}

}  // namespace spark::script
