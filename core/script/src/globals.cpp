#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "environment.h"
#include "nodes.h"
#include "runtime.h"
#include "values.h"

// The globals by which scripts use the tree. Upvalue 1 of these functions is the node of the script (the root for
// configs), upvalue 2 its environment.

namespace spark::script {

namespace {
/// The node of the script whose function runs.
Leaf& scriptNode(lua_State* L) { return *toNode(L, lua_upvalueindex(1)); }

int plugin(lua_State* L) {
  pushNode(L, &State::of(L).runtime().kernel.plugins().use(checkString(L, 1, "a plugin's name")));
  return 1;
}

int unload(lua_State* L) {
  State::of(L).runtime().kernel.plugins().unloadLater(checkString(L, 1, "a plugin's name"));
  return 0;
}

int create(lua_State* L) {
  Runtime& runtime = State::of(L).runtime();
  const Ref<Leaf> made(&runtime.kernel.create(checkString(L, 1, "a class name"), checkString(L, 2, "a path")));
  runtime.settings.apply();
  pushNode(L, made.get());
  return 1;
}

int get(lua_State* L) {
  pushNode(L, scriptNode(L).find(checkString(L, 1, "a path")));
  return 1;
}

int remove(lua_State* L) {
  Leaf* found = nullptr;
  if (lua_type(L, 1) == LUA_TSTRING) {
    const std::string path(checkString(L, 1, "a path"));
    found = scriptNode(L).find(path);
    if (!found) throw Error(fmt::format("cannot delete {}: there is no such node", path));
  } else {
    found = toNode(L, 1);
  }
  if (!found) throw Error(fmt::format("delete expected a path or a node, found a {}", typeAt(L, 1)));
  deleteNode(L, *found);
  return 0;
}

int option(lua_State* L) {
  static const std::vector<std::string> known{"name", "default", "doc", "choices", "secret"};
  if (!lua_istable(L, 1))
    throw Error(fmt::format(
        "option expected a table: option{{name = \"agents\", default = 11, doc = \"...\"}}, found a {}", typeAt(L, 1)));

  // A misspelt field is an error.
  lua_settop(L, 1);
  for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1)) {
    std::string key;
    appendText(L, -2, key);
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw Error(fmt::format("option knows no field '{}'.{} It has name, default, doc, choices and secret.", key,
                              didYouMean(key, known)));
  }

  lua_getfield(L, 1, "name");
  const std::string name(checkString(L, -1, "an option's name"));
  lua_getfield(L, 1, "default");
  const Value defaultValue = toValue(L, -1);
  lua_getfield(L, 1, "doc");
  const std::string doc(lua_isnil(L, -1) ? std::string_view() : checkString(L, -1, "an option's doc"));
  lua_getfield(L, 1, "choices");
  Value choices = toValue(L, -1);
  if (choices.isNil()) choices = List{};
  if (!choices.isList())
    throw Error(fmt::format("option '{}' expected a list of choices, found {}", name, choices.text()));
  lua_getfield(L, 1, "secret");
  const bool secret = lua_toboolean(L, -1) != 0;
  pushValue(L, State::of(L).runtime().settings.declare(name, defaultValue, doc, choices.toList(), secret));
  return 1;
}

int include(lua_State* L) {
  const std::string file(checkString(L, 1, "a file name"));
  const std::string text = State::of(L).runtime().readInclude(file, L).text;
  lua_settop(L, 0);
  Runtime::load(L, text, fmt::format("@{}", file), lua_upvalueindex(2));
  lua_call(L, 0, LUA_MULTRET);
  return lua_gettop(L);
}

int handle(lua_State* L) { return subscribe(L, scriptNode(L), 1); }

/// Logs its arguments as print would show them. Upvalue 1 is the level.
int writeLog(lua_State* L) {
  Log& log = State::of(L).runtime().kernel.log();
  const auto level = static_cast<Level>(lua_tointeger(L, lua_upvalueindex(1)));
  if (!log.enabled(level)) return 0;
  std::string line;
  for (int i = 1; i <= lua_gettop(L); ++i) {
    if (i > 1) line += ' ';
    appendText(L, i, line);
  }
  log.write(level, line);
  return 0;
}

/// Pushes a function that logs at a level.
void pushLog(lua_State* L, Level level) {
  lua_pushinteger(L, static_cast<lua_Integer>(level));
  lua_pushcclosure(L, guarded<writeLog>, 1);
}

/// __index of an environment: a global that was not set is the group of variables of that name, else nil.
int findNamespace(lua_State* L) {
  Leaf* found = nullptr;
  if (lua_type(L, 2) == LUA_TSTRING)
    if (const auto* groups = State::of(L).runtime().kernel.root().find<Node>("/sys/variables"))
      found = groups->child(checkString(L, 2, "a name"));
  pushNode(L, found);
  return 1;
}
}  // namespace

void addGlobals(lua_State* L, Leaf& node, bool config) {
  const int environment = lua_gettop(L);
  pushNode(L, &node);
  const int nodeIndex = lua_gettop(L);
  if (!config) {
    lua_pushvalue(L, nodeIndex);
    lua_setfield(L, environment, "self");
  }
  constexpr luaL_Reg kAll[] = {{"on", guarded<handle>}};
  constexpr luaL_Reg kTrusted[] = {
      {"plugin", guarded<plugin>}, {"unload", guarded<unload>}, {"new", guarded<create>},     {"get", guarded<get>},
      {"delete", guarded<remove>}, {"option", guarded<option>}, {"include", guarded<include>}};
  const bool trusted = State::of(L).trusted();
  const auto add = [&](std::span<const luaL_Reg> functions) {
    for (const luaL_Reg& f : functions) {
      lua_pushvalue(L, nodeIndex);
      lua_pushvalue(L, environment);
      lua_pushcclosure(L, f.func, 2);
      lua_setfield(L, environment, f.name);
    }
  };
  add(kAll);
  if (trusted) {
    add(kTrusted);
    // print, and the functions of log.
    pushLog(L, Level::info);
    lua_setfield(L, environment, "print");
    lua_newtable(L);
    for (const auto& [name, level] : {std::pair("debug", Level::debug),
                                      {"info", Level::info},
                                      {"warning", Level::warning},
                                      {"error", Level::error}}) {
      pushLog(L, level);
      lua_setfield(L, -2, name);
    }
    lua_setfield(L, environment, "log");
    // The metatable, which scripts cannot replace.
    lua_newtable(L);
    lua_pushcfunction(L, guarded<findNamespace>);
    lua_setfield(L, -2, "__index");
    lua_pushliteral(L, "environment");
    lua_setfield(L, -2, "__metatable");
    lua_setmetatable(L, environment);
  }
  lua_settop(L, environment);
}

}  // namespace spark::script
