#include "memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "nodes.h"
#include "runtime.h"
#include "spark/error.h"
#include "values.h"

namespace spark::script {

namespace {
constexpr const char* kTable = "state";
constexpr int kDeepest = 32;  // tables in tables

/// The types of saved values.
enum class Kind { nil, boolean, integer, number, text, table, node };

void write(StateWriter& out, Kind kind) { out.write(static_cast<int>(kind)); }

/// Writes the value at an absolute index. `name` is that of the value, for errors.
void save(lua_State* L, int index, StateWriter& out, const std::string& name, int depth) {
  luaL_checkstack(L, 8, "state is nested too deep");
  switch (lua_type(L, index)) {
    case LUA_TNIL:
      return write(out, Kind::nil);
    case LUA_TBOOLEAN:
      return write(out, Kind::boolean), out.write(lua_toboolean(L, index) != 0);
    case LUA_TNUMBER:
      if (lua_isinteger(L, index))
        return write(out, Kind::integer), out.write(static_cast<std::int64_t>(lua_tointeger(L, index)));
      return write(out, Kind::number), out.write(static_cast<double>(lua_tonumber(L, index)));
    case LUA_TSTRING:
      return write(out, Kind::text), out.write(textAt(L, index));
    case LUA_TTABLE:
      break;
    default:
      if (const Leaf* leaf = toNode(L, index)) return write(out, Kind::node), out.write(leaf->path());
      throw Error(fmt::format("{} is a {}; expected a number, text, boolean, table or node", name, typeAt(L, index)));
  }
  if (depth == kDeepest) throw Error(fmt::format("{} is nested more than {} deep, or holds itself", name, kDeepest));
  const lua_Integer count = pushSortedKeys(L, index);
  const int keys = lua_gettop(L);
  write(out, Kind::table);
  out.write(static_cast<std::int64_t>(count));
  for (lua_Integer i = 1; i <= count; ++i) {
    lua_rawgeti(L, keys, i);
    std::string inner = name + ".";
    appendText(L, -1, inner);
    save(L, lua_gettop(L), out, inner, depth + 1);
    lua_rawget(L, index);
    save(L, lua_gettop(L), out, inner, depth + 1);
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
}

void load(lua_State* L, StateReader& in, int into);

/// Fills the table at `table` with what comes, and empties it of all else. Tables in it stay the same tables.
void loadTable(lua_State* L, StateReader& in, int table) {
  // What was in it, which load() may fill.
  lua_newtable(L);
  const int before = lua_gettop(L);
  for (lua_pushnil(L); lua_next(L, table);) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, before);
  }
  for (lua_pushnil(L); lua_next(L, before); lua_pop(L, 1)) {
    lua_pushvalue(L, -2);
    lua_pushnil(L);
    lua_rawset(L, table);
  }
  for (std::size_t n = in.readCount(); n > 0; --n) {
    load(L, in, 0);
    if (lua_isnil(L, -1)) throw Error("expected a key of a table, found nil");
    lua_pushvalue(L, -1);
    lua_rawget(L, before);
    load(L, in, lua_istable(L, -1) ? lua_gettop(L) : 0);
    lua_remove(L, -2);
    lua_rawset(L, table);
  }
  lua_pop(L, 1);
}

/// Pushes what comes; a table into the one at `into` where that is not 0.
void load(lua_State* L, StateReader& in, int into) {
  luaL_checkstack(L, 8, "state is nested too deep");
  switch (static_cast<Kind>(in.readInteger())) {
    case Kind::nil:
      return lua_pushnil(L);
    case Kind::boolean:
      return lua_pushboolean(L, in.readBool());
    case Kind::integer:
      return lua_pushinteger(L, in.readInteger());
    case Kind::number:
      return lua_pushnumber(L, in.readNumber());
    case Kind::text:
      return pushText(L, in.readString());
    case Kind::table:
      if (into != 0)
        lua_pushvalue(L, into);
      else
        lua_newtable(L);
      return loadTable(L, in, lua_gettop(L));
    case Kind::node:
      return pushNode(L, State::of(L).runtime().kernel.root().find(in.readString()));
  }
  throw Error("expected a value of a script's state, found an unknown type");
}

/// Adds the addresses of the table at an absolute index and of those in it.
void addTables(lua_State* L, int index, std::set<const void*>& out) {
  if (!lua_istable(L, index) || !out.insert(lua_topointer(L, index)).second) return;
  luaL_checkstack(L, 4, "tables in tables");
  for (lua_pushnil(L); lua_next(L, index); lua_pop(L, 1)) addTables(L, lua_gettop(L), out);
}
}  // namespace

Memory::~Memory() {
  for (const Entry& e : entries_)
    if (const auto state = e.state.lock()) state->release(e.environment), state->release(e.stream);
}

void Memory::forgetGone() {
  std::erase_if(entries_, [](const Entry& e) {
    const auto state = e.state.lock();
    if (state && !state->closed() && e.owner) return false;
    if (state) state->release(e.environment), state->release(e.stream);
    return true;
  });
}

void Memory::add(lua_State* L, Leaf& owner, int environment) {
  forgetGone();
  Entry e;
  e.state = State::of(L).weak_from_this();
  e.owner = Ref<Leaf>(&owner);
  lua_pushvalue(L, -1);
  e.stream = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_pushvalue(L, environment);
  e.environment = luaL_ref(L, LUA_REGISTRYINDEX);
  entries_.push_back(std::move(e));
}

std::set<const void*> Memory::tables(lua_State* L) {
  std::set<const void*> out;
  forgetGone();
  for (const Entry& e : entries_) {
    if (e.state.lock().get() != &State::of(L)) continue;
    luaL_checkstack(L, 4, "tables of scripts");
    lua_rawgeti(L, LUA_REGISTRYINDEX, e.environment);
    pushText(L, kTable);
    lua_rawget(L, -2);
    addTables(L, lua_gettop(L), out);
    lua_pop(L, 2);
  }
  return out;
}

void Memory::save(StateWriter& out) {
  forgetGone();
  out.write(static_cast<std::int64_t>(entries_.size()));
  for (Entry& e : entries_) {
    const auto state = e.state.lock();
    StateWriter own(true);
    RandomStream numbers(0);
    bool seeded = false;
    const auto failure = state->run(kUnlimited, [&](lua_State* L) {
      lua_rawgeti(L, LUA_REGISTRYINDEX, e.stream);
      const auto& stream = *static_cast<const Stream*>(lua_touserdata(L, -1));
      numbers = stream.numbers, seeded = stream.seeded;
      lua_rawgeti(L, LUA_REGISTRYINDEX, e.environment);
      pushText(L, kTable);
      lua_rawget(L, -2);
      script::save(L, lua_gettop(L), own, kTable, 0);
    });
    out.write(seeded);
    out.write(Convert<RandomStream>::to(numbers));
    out.write(failure ? std::string_view() : std::string_view(own.bytes()));
    if (failure && !std::exchange(e.reported, true))
      state->runtime().kernel.log().warning(
          "the script at {} keeps what cannot be saved, so its table `state` is not: {}", e.owner->path(),
          failure->text);
  }
}

void Memory::load(StateReader& in) {
  forgetGone();
  if (const std::size_t count = in.readCount(); count != entries_.size())
    throw Error(fmt::format("expected the state of {} scripts, found that of {}", entries_.size(), count));
  for (const Entry& e : entries_) {
    const bool seeded = in.readBool();
    const Value numbers = branched(in.readValue(), in.branch());
    const std::string own = in.readString();
    const auto failure = e.state.lock()->run(kUnlimited, [&](lua_State* L) {
      lua_rawgeti(L, LUA_REGISTRYINDEX, e.stream);
      auto& stream = *static_cast<Stream*>(lua_touserdata(L, -1));
      Args args{std::span(&numbers, 1)};
      stream.numbers = Convert<RandomStream>::from(args), stream.seeded = seeded;
      if (own.empty()) return;
      StateReader reader(own);
      lua_rawgeti(L, LUA_REGISTRYINDEX, e.environment);
      const int environment = lua_gettop(L);
      pushText(L, kTable);
      pushText(L, kTable);
      lua_rawget(L, environment);
      script::load(L, reader, lua_istable(L, -1) ? lua_gettop(L) : 0);
      lua_remove(L, -2);
      lua_rawset(L, environment);
    });
    if (failure) throw Error(fmt::format("the state of the script at {}: {}", e.owner->path(), failure->text));
  }
}

}  // namespace spark::script
