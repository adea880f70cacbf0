// What --check says of handlers that keep what is not saved.
#include "absence.h"
#include "lua_fixture.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;

namespace {
/// The warnings that a config gives when its handlers are looked through.
struct Checked : LuaHost {
  std::string operator()(const std::string& config) {
    scripts(kernel).warnOfUnsaved();
    text.clear();
    thing("/usr/thing");
    CHECK(configFailure(config) == "");
    return text;
  }
};
std::string warnings(const std::string& config) { return Checked()(config); }
}  // namespace

TEST_CASE("A handler that sets a global or a local of its script is named, with its line") {
  CHECK_THAT(warnings("falls = 0\non('rule', function()\n  falls = falls + 1\nend)"),
             Contains("config.lua:3: sets the global 'falls', in a handler of 'rule'") &&
                 Contains("Keep it in the table `state`"));
  CHECK_THAT(warnings("local falls = 0\non('rule', function()\n\n  falls = falls + 1\nend)"),
             Contains("config.lua:4: sets the local 'falls' outside of it"));
  CHECK_THAT(warnings("on('rule', function() first = 1 end)"), Contains("config.lua:1: sets the global 'first'"));
}

TEST_CASE("A handler that writes into a table outside of it is named") {
  for (const char* write :
       {"seen.last = 1", "seen[event.cycle] = 1", "seen[1] = 1", "seen.inner.last = 1", "local s = seen s.last = 1",
        "for i = 1, 3 do seen[i] = i end", "for _, n in ipairs{1, 2} do seen[n] = n end"}) {
    INFO(write);
    const std::string handler = std::string("on('rule', function(self, event)\n") + write + "\nend)";
    CHECK_THAT(warnings("local seen = { inner = {} }\n" + handler),
               Contains("config.lua:3: writes into the table in the local 'seen' outside of it"));
    CHECK_THAT(warnings("seen = { inner = {} }\n" + handler),
               Contains("config.lua:3: writes into the table in the global 'seen'"));
    CHECK(warnings("local seen = { inner = {} }\nstate.seen = seen\n" + handler) == "");
    CHECK(warnings("state.seen = { inner = {} }\nlocal seen = state.seen\n" + handler) == "");
  }
}

TEST_CASE("Functions that a handler calls, and functions in it, are looked through as well") {
  CHECK_THAT(warnings("local n = 0\nlocal function count()\n  n = n + 1\nend\non('rule', function() count() end)"),
             Contains("config.lua:3: sets the local 'n' outside of it"));
  CHECK_THAT(warnings("n = 0\nfunction count()\n  n = n + 1\nend\non('rule', function() count() end)"),
             Contains("config.lua:3: sets the global 'n'"));
  CHECK_THAT(warnings("local n\non('rule', function()\n  local f = function()\n    n = 1\n  end\n  f()\nend)"),
             Contains("config.lua:4: sets the local 'n' outside of it"));
  CHECK_THAT(warnings("function a() b() n = 1 end\nfunction b() a() end\non('rule', a)"), Contains("the global 'n'"));
}

TEST_CASE("Handlers that keep nothing, or keep it in `state` and in nodes, are not named") {
  for (const char* config :
       {"on('rule', function() state.n = (state.n or 0) + 1 end)", "on('rule', function() state = { n = 1 } end)",
        "state.a = { b = {} }\nlocal b = state.a.b\non('rule', function(self, event) b[event.cycle] = 1 end)",
        "local thing = get '/usr/thing'\non('rule', function(self) thing.count = 1 self.count = 2 end)",
        "on('rule', function() local n = 0 local function f() n = n + 1 end f() end)",
        "on('rule', function() local t = {} t.x = 1 t[2] = 3 table.sort(t) end)",
        "local limit, names = 3, { 'a' }\non('rule', function() for i, n in ipairs(names) do if i > limit then "
        "print(n) "
        "end end end)",
        "on('rule', function() local t = { 1, 2, n = 3 } for k, v in pairs(t) do t[k] = v + 1 end return t end)",
        "on('rule', print)"}) {
    INFO(config);
    CHECK(lacks(warnings(config), "is neither saved nor hashed", warnings("on('rule', function() first = 1 end)")));
  }
}

TEST_CASE("Functions of many lines, constants and upvalues are read") {
  std::string config = "local t = { ";
  for (int i = 0; i < 200; ++i) config += "k" + std::to_string(i) + " = " + std::to_string(i) + ".5, ";
  config += "}\non('rule', function(self)\n  local x = { ";
  for (int i = 0; i < 300; ++i) config += "k" + std::to_string(i) + " = " + std::to_string(i * 1000) + ",\n";
  config += "}\n" + std::string(400, '\n') +
            "  t.k7 = 'a long text that is no short string of Lua, because it has more than forty letters'\nend)";
  CHECK_THAT(warnings(config), Contains("config.lua:704: writes into the table in the local 't' outside of it"));
}
