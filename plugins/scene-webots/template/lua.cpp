#include "lua.h"

#include <fmt/format.h>

#include <cmath>
#include <lua.hpp>

#include "texts.h"

namespace spark::templates {

namespace {

using nlohmann::json;

constexpr int kMaxDepth = 100;  ///< of nodes in fields

Reply& replyOf(lua_State* lua) { return **static_cast<Reply**>(lua_getextraspace(lua)); }

int write(lua_State* lua) {
  const double piece = luaL_checknumber(lua, 1);
  bool fits = false;
  if (lua_gettop(lua) == 1) {
    fits = replyOf(lua).write(piece);
  } else {
    std::size_t size = 0;
    const char* const text = luaL_tolstring(lua, 2, &size);
    fits = replyOf(lua).write(piece, std::string(text, size));
  }
  return fits ? 0 : luaL_error(lua, "the template writes more than %d MiB", static_cast<int>(kMostWritten >> 20));
}

int say(lua_State* lua) {
  std::size_t size = 0;
  const char* const text = luaL_checklstring(lua, 1, &size);
  replyOf(lua).say({text, size});
  return 0;
}

void push(lua_State* lua, const json& value, int depth = 0) {
  luaL_checkstack(lua, 4, "fields");
  if (value.is_boolean()) return lua_pushboolean(lua, value.get<bool>());
  if (value.is_string()) return static_cast<void>(lua_pushstring(lua, value.get_ref<const std::string&>().c_str()));
  if (value.is_number()) {
    const double number = value.get<double>();
    // Whole numbers are written without a point.
    if (number == std::floor(number) && std::abs(number) < 1e15) return lua_pushinteger(lua, std::llround(number));
    return lua_pushnumber(lua, number);
  }
  if (!value.is_structured() || depth > kMaxDepth) return lua_pushnil(lua);
  lua_newtable(lua);
  lua_Integer index = 0;
  for (const auto& [key, item] : value.items()) {
    push(lua, item, depth + 1);
    if (value.is_array())
      lua_rawseti(lua, -2, ++index);
    else
      lua_setfield(lua, -2, key.c_str());
  }
}

/// A library without the functions that reach files or compiled code.
void openLibraries(lua_State* lua) {
  for (const auto& [name, open] : {std::pair<const char*, lua_CFunction>{"_G", luaopen_base},
                                   {"string", luaopen_string},
                                   {"table", luaopen_table},
                                   {"math", luaopen_math},
                                   {"utf8", luaopen_utf8}}) {
    luaL_requiref(lua, name, open, 1);
    lua_pop(lua, 1);
  }
  for (const char* name : {"dofile", "loadfile", "load", "collectgarbage"}) {
    lua_pushnil(lua);
    lua_setglobal(lua, name);
  }
}

struct Job {
  const Request& request;
};

/// Everything that may fail, in protected mode.
int run(lua_State* lua) {
  const Request& request = static_cast<const Job*>(lua_touserdata(lua, 1))->request;
  openLibraries(lua);
  lua_pushcfunction(lua, write);
  lua_setglobal(lua, "spark_write");
  if (luaL_loadbufferx(lua, kLuaModules.data(), kLuaModules.size(), "=modules", "t") != LUA_OK) return lua_error(lua);
  push(lua, request.fields);
  push(lua, request.context);
  lua_pushcfunction(lua, say);
  lua_call(lua, 3, 0);
  if (luaL_loadbufferx(lua, request.text.data(), request.text.size(), "=line", "t") != LUA_OK) return lua_error(lua);
  lua_call(lua, 0, 0);
  return 0;
}

/// An allocator that stops at the limit.
void* allocate(void* used, void* old, std::size_t oldSize, std::size_t size) {
  std::size_t& sum = *static_cast<std::size_t*>(used);
  if (!old) oldSize = 0;
  if (size > oldSize && sum + (size - oldSize) > kMostMemory) return nullptr;
  void* const out = size == 0 ? (std::free(old), nullptr) : std::realloc(old, size);
  if (out || size == 0) sum += size - oldSize;
  return out;
}

}  // namespace

void runLua(const Request& request, Reply& reply) {
  std::size_t used = 0;
  lua_State* const lua = lua_newstate(allocate, &used);
  if (!lua) {
    reply.error = "no memory for Lua";
    return;
  }
  *static_cast<Reply**>(lua_getextraspace(lua)) = &reply;
  Job job{request};
  lua_pushcfunction(lua, run);
  lua_pushlightuserdata(lua, &job);
  const int result = lua_pcall(lua, 1, 0, 0);
  if (result == LUA_ERRMEM)
    reply.error = fmt::format("it needs more than {} MiB of memory", kMostMemory >> 20);
  else if (result != LUA_OK)
    reply.error = luaL_tolstring(lua, -1, nullptr);
  lua_close(lua);
}

}  // namespace spark::templates
