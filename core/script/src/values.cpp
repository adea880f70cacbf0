#include "values.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "nodes.h"
#include "spark/error.h"
#include "spark/leaf.h"
#include "state.h"

namespace spark::script {

namespace {
constexpr int kMaxNesting = 64;  // tables in tables

/// A key of a table. Keys are ordered: numbers, strings, false and true, nodes by id.
struct Key {
  enum class Kind { number, string, boolean, node } kind = Kind::number;
  bool integral = false;    ///< a number that is an integer
  lua_Integer integer = 0;  ///< an integer, a boolean, the id of a node
  lua_Number number = 0;    ///< a float
  std::string_view text;    ///< of a string, which its table keeps alive
  lua_Integer position = 0;

  bool operator<(const Key& o) const {
    if (kind != o.kind) return kind < o.kind;
    if (kind == Kind::string) return text < o.text;
    if (kind == Kind::number && !(integral && o.integral)) {
      // Lua makes integers of floats that are integral, so beyond 2^53, where the cast could round, at most one of the
      // two is a float.
      const lua_Number a = integral ? static_cast<lua_Number>(integer) : number,
                       b = o.integral ? static_cast<lua_Number>(o.integer) : o.number;
      return a < b;
    }
    return integer < o.integer;
  }
};

Key keyAt(lua_State* L, int index) {
  Key k;
  switch (lua_type(L, index)) {
    case LUA_TNUMBER:
      k.integral = lua_isinteger(L, index);
      if (k.integral)
        k.integer = lua_tointeger(L, index);
      else
        k.number = lua_tonumber(L, index);
      return k;
    case LUA_TSTRING:
      k.kind = Key::Kind::string;
      k.text = textAt(L, index);
      return k;
    case LUA_TBOOLEAN:
      k.kind = Key::Kind::boolean;
      k.integer = lua_toboolean(L, index);
      return k;
    default:
      break;
  }
  if (const Leaf* leaf = toNode(L, index)) {
    k.kind = Key::Kind::node;
    k.integer = static_cast<lua_Integer>(leaf->id());
    return k;
  }
  throw Error(
      fmt::format("cannot go through this table: a key is a {}, which has no order that is the same in every run. Use "
                  "numbers, strings or nodes as keys, or ipairs.",
                  typeAt(L, index)));
}

Value toValueNested(lua_State* L, int index, int depth);

Value tableToValue(lua_State* L, int index, int depth) {
  if (depth > kMaxNesting)
    throw Error(fmt::format("cannot pass this table: it is nested more than {} deep, or holds itself", kMaxNesting));
  if (!lua_checkstack(L, 8)) throw Error("cannot pass this table: no stack left");
  const auto length = static_cast<lua_Integer>(lua_rawlen(L, index));
  lua_Integer keys = 0;
  for (lua_pushnil(L); lua_next(L, index); lua_pop(L, 1)) ++keys;
  List list;
  // A sequence, or an empty table.
  if (keys == length) {
    for (lua_Integer i = 1; i <= length; ++i) {
      lua_rawgeti(L, index, i);
      list.push_back(toValueNested(L, lua_gettop(L), depth + 1));
      lua_pop(L, 1);
    }
    return list;
  }
  // Any other table becomes a list of [key, value] pairs.
  pushSortedKeys(L, index);
  const int sorted = lua_gettop(L);
  for (lua_Integer i = 1; i <= keys; ++i) {
    lua_rawgeti(L, sorted, i);
    Value key = toValueNested(L, lua_gettop(L), depth + 1);
    lua_rawget(L, index);
    list.push_back(List{std::move(key), toValueNested(L, lua_gettop(L), depth + 1)});
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
  return list;
}

Value toValueNested(lua_State* L, int index, int depth) {
  switch (lua_type(L, index)) {
    case LUA_TNONE:
    case LUA_TNIL:
      return {};
    case LUA_TBOOLEAN:
      return static_cast<bool>(lua_toboolean(L, index));
    case LUA_TNUMBER:
      if (lua_isinteger(L, index)) return static_cast<std::int64_t>(lua_tointeger(L, index));
      return static_cast<double>(lua_tonumber(L, index));
    case LUA_TSTRING:
      return textAt(L, index);
    case LUA_TTABLE:
      return tableToValue(L, index, depth);
    default:
      break;
  }
  if (const Leaf* leaf = toNode(L, index)) return leaf->path();
  throw Error(
      fmt::format("expected a value (nil, boolean, number, string, table or node), found a {}", typeAt(L, index)));
}
}  // namespace

std::string typeAt(lua_State* L, int index) {
  if (luaL_getmetafield(L, index, "__name") == LUA_TNIL) return luaL_typename(L, index);
  const char* name = lua_tostring(L, -1);
  std::string out = name ? name : luaL_typename(L, index);
  lua_pop(L, 1);
  return out;
}

std::string_view textAt(lua_State* L, int index) {
  std::size_t n = 0;
  const char* s = lua_tolstring(L, index, &n);
  return s ? std::string_view(s, n) : std::string_view();
}

std::string_view checkString(lua_State* L, int index, const char* what) {
  if (lua_type(L, index) != LUA_TSTRING)
    throw Error(fmt::format("expected {} (a string), found {}", what, typeAt(L, index)));
  return textAt(L, index);
}

void appendText(lua_State* L, int index, std::string& out) {
  // luaL_tolstring would show an address for a type that has no text of its own.
  const bool plain = lua_isnoneornil(L, index) || lua_isboolean(L, index) || lua_isstring(L, index);
  if (!plain && luaL_getmetafield(L, index, "__tostring") == LUA_TNIL) {
    out += typeAt(L, index);
    return;
  }
  if (!plain) lua_pop(L, 1);
  luaL_tolstring(L, index, nullptr);
  out += textAt(L, -1);
  lua_pop(L, 1);
}

void pushText(lua_State* L, std::string_view text) { lua_pushlstring(L, text.data(), text.size()); }

void pushValue(lua_State* L, const Value& value) {
  switch (value.type()) {
    case Value::Type::nil:
      return lua_pushnil(L);
    case Value::Type::boolean:
      return lua_pushboolean(L, value.toBool());
    case Value::Type::integer:
      return lua_pushinteger(L, value.toInteger());
    case Value::Type::number:
      return lua_pushnumber(L, value.toNumber());
    case Value::Type::string:
      return pushText(L, value.toString());
    case Value::Type::list:
      break;
  }
  const List& list = value.toList();
  luaL_checkstack(L, 4, "a value is nested too deep");
  lua_createtable(L, static_cast<int>(list.size()), 0);
  lua_Integer i = 0;
  for (const Value& v : list) {
    pushValue(L, v);
    lua_rawseti(L, -2, ++i);
  }
}

namespace {
/// True for a list of pairs whose keys are strings.
bool isTable(const Value& v) {
  return v.isList() && !v.toList().empty() && std::all_of(v.toList().begin(), v.toList().end(), [](const Value& p) {
           return p.isList() && p.toList().size() == 2 && p.toList()[0].isString();
         });
}
}  // namespace

void pushTables(lua_State* L, const Value& value) {
  if (!value.isList()) return pushValue(L, value);
  luaL_checkstack(L, 4, "a value is nested too deep");
  lua_newtable(L);
  const bool named = isTable(value);
  lua_Integer i = 0;
  for (const Value& e : value.toList()) {
    if (named)
      pushValue(L, e.toList()[0]);
    else
      lua_pushinteger(L, ++i);
    pushTables(L, named ? e.toList()[1] : e);
    lua_rawset(L, -3);
  }
}

void pushArguments(lua_State* L, const Value& arguments) {
  if (!arguments.isNil()) pushTables(L, arguments);
}

Value toValue(lua_State* L, int index) { return toValueNested(L, lua_absindex(L, index), 0); }

lua_Integer pushSortedKeys(lua_State* L, int table) {
  table = lua_absindex(L, table);
  // A sequence of the keys in the order of traversal, and the permutation that sorts them.
  std::vector<Key> keys;
  lua_newtable(L);
  const int unsorted = lua_gettop(L);
  for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
    keys.push_back(keyAt(L, -2));
    keys.back().position = static_cast<lua_Integer>(keys.size());
    lua_pushvalue(L, -2);
    lua_rawseti(L, unsorted, keys.back().position);
  }
  State::of(L).charge(L, 4 * keys.size());  // as for table.sort
  std::sort(keys.begin(), keys.end());
  // The sorted sequence.
  lua_createtable(L, static_cast<int>(keys.size()), 0);
  lua_Integer i = 0;
  for (const Key& k : keys) {
    lua_rawgeti(L, unsorted, k.position);
    lua_rawseti(L, -2, ++i);
  }
  lua_remove(L, unsorted);
  return static_cast<lua_Integer>(keys.size());
}

void pushNextKey(lua_State* L, int table, int after) {
  // The smallest key that is greater than `low`.
  std::optional<Key> low, best;
  if (after != 0) low = keyAt(L, after);
  lua_pushnil(L);
  const int found = lua_gettop(L);
  for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
    State::of(L).charge(L);
    const Key k = keyAt(L, -2);
    if ((low && !(*low < k)) || (best && !(k < *best))) continue;
    best = k;
    lua_pushvalue(L, -2);
    lua_replace(L, found);
  }
}

}  // namespace spark::script
