// Untrusted scripts: what they can use, what they cannot use, and their limits.
#include "lua_fixture.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;
using Catch::Equals;

namespace {
/// Attaches untrusted text to a new node /usr/a and returns the error, "" when there is none.
std::string sandbox(LuaHost& h, std::string_view text) {
  Leaf* a = h.kernel.root().find("/usr/a");
  Thing& node = a ? *a->as<Thing>() : h.thing("/usr/a");
  return LuaHost::errorOf([&] { scripts(h.kernel).attachText(node, text, "guest", false); });
}
}  // namespace

TEST_CASE("an untrusted script can compute and change its own node") {
  LuaHost h;
  CHECK(sandbox(h,
                "local t = {} for i = 1, 10 do table.insert(t, i * 2) end\n"
                "self.count = #t; self.label = string.format('%02d', math.floor(7.5)) .. ('x'):upper():rep(2); "
                "self.mass = self:add(1, 2)\n"
                "self:on('tick', function(node, e) node.count = node.count + 1 end)") == "");
  h.emit("tick");
  Thing& a = *h.kernel.root().find<Thing>("/usr/a");
  CHECK(a.count == 11);
  CHECK(a.label == "07XX");
  CHECK(a.mass == 3);
}

TEST_CASE("an untrusted script has only pure functions and self") {
  LuaHost h;
  CHECK(sandbox(h, "local n = {} for k in pairs(_G) do n[#n + 1] = k end self.anything = n") == "");
  CHECK(h.kernel.root().find<Thing>("/usr/a")->anything ==
        Value(List{"_G",     "assert",   "error",    "ipairs",   "math",   "next",   "on",   "pairs",
                   "pcall",  "rawequal", "rawget",   "rawlen",   "rawset", "select", "self", "state",
                   "string", "table",    "tonumber", "tostring", "type",   "utf8"}));
  CHECK(sandbox(h,
                "local n = {} for k in pairs(string) do n[#n + 1] = k end self.anything = {n, ('').find, ('').gsub}") ==
        "");
  CHECK(h.kernel.root().find<Thing>("/usr/a")->anything ==
        Value(List{List{"byte", "char", "format", "len", "lower", "rep", "reverse", "sub", "upper"}}));
}

TEST_CASE("an untrusted script sees only its own node and the nodes below") {
  LuaHost h;
  h.thing("/usr/a").create("Thing", "below");
  h.thing("/usr/other");
  CHECK(sandbox(h,
                "self.anything = {self:find('below').path, self:find('below').parent == self, self.parent == nil, "
                "self:find('../other') == nil, "
                "self:find('/') == nil, #self:children()}") == "");
  CHECK(h.kernel.root().find<Thing>("/usr/a")->anything == Value(List{"/usr/a/below", true, true, true, true, 1}));
}

TEST_CASE("an untrusted script cannot make nodes, delete nodes or attach scripts") {
  LuaHost h;
  CHECK_THAT(sandbox(h, "self:new('Thing')"),
             Equals("the script attached to /usr/a failed: guest:1: node:new is not for untrusted scripts"));
  CHECK_THAT(sandbox(h, "self:delete()"), Contains("guest:1: delete is not for untrusted scripts"));
  for (const char* name : {"attach", "attachScript"})
    CHECK_THAT(sandbox(h, std::string("self:") + name + "('x.lua')"),
               Contains("guest:1: node:attachScript is not for untrusted scripts"));
}

TEST_CASE("an untrusted script that computes too long is stopped") {
  LuaHost h;
  CHECK_THAT(sandbox(h, "\nwhile true do end"), Equals("the script attached to /usr/a failed: guest:2: stopped after "
                                                       "1000000 instructions: is there an endless loop?"));
  CHECK_THAT(sandbox(h, "while true do pcall(function() while true do end end) end"),
             Contains("stopped after 1000000 instructions"));
}

TEST_CASE("an untrusted handler that computes too long is stopped and logged") {
  LuaHost h;
  CHECK(sandbox(h, "on('tick', function()\n  while true do end\nend)") == "");
  h.emit("tick");
  CHECK_THAT(h.text, Contains("handler of 'tick' at /usr/a failed: guest:2: stopped after 1000000 instructions"));
}

TEST_CASE("library functions are charged for the size of their data") {
  LuaHost h;
  const char* const loops[] = {
      "local s = ('x'):rep(500000) while true do local u = s:upper() end",
      "local s = ('x'):rep(500000) while true do local n = #s:sub(1, 2) end",
      "local t = {} for i = 1, 20000 do t[i] = i end while true do table.insert(t, 1, 0) table.remove(t, 1) end",
      "local t = {} for i = 1, 20000 do t[i] = i end while true do next(t, 5) end",
      "local s = ('x'):rep(500000) while true do local u = s .. 'y' end"};
  for (const char* loop : loops) {
    INFO(loop);
    CHECK_THAT(sandbox(h, loop), Contains("stopped after 1000000 instructions"));
  }
}

TEST_CASE("huge counts do not block a function of the sandbox") {
  LuaHost h;
  CHECK(sandbox(h, "self.label = (''):rep(9223372036854775807)") == "");
  CHECK_THAT(sandbox(h, "table.concat({}, '', 1, 9223372036854775806)"), Contains("invalid value"));
}

TEST_CASE("an untrusted script that allocates too much memory is stopped") {
  LuaHost h;
  CHECK_THAT(sandbox(h, "local s = ('x'):rep(1000) while true do s = s .. s end"),
             Equals("the script attached to /usr/a failed: used up its memory: an untrusted script may hold 2 MiB"));
  CHECK_THAT(sandbox(h, "local t = {} for i = 1, 1e9 do t[i] = {} end"),
             Contains("used up its memory: an untrusted script may hold 2 MiB"));
  CHECK_THAT(sandbox(h, "local s = ('x'):rep(1e9)"), Contains("used up its memory"));
  CHECK(h.run("local t = {} for i = 1, 1e5 do t[i] = {} end return #t") ==
        Value(100000));  // trusted scripts may hold more
}

TEST_CASE("an untrusted script may allocate any amount of memory if it also releases it") {
  LuaHost h;
  CHECK(
      sandbox(
          h,
          "for i = 1, 400 do local t = {} for k = 1, 400 do t[k] = k end end self.count = collectgarbage and 0 or 1") ==
      "");
  CHECK(h.kernel.root().find<Thing>("/usr/a")->count == 1);
}

TEST_CASE("untrusted scripts share nothing with each other") {
  LuaHost h;
  Thing& b = h.thing("/usr/b");
  CHECK(sandbox(h, "mine = 1 string.rep = nil") == "");
  scripts(h.kernel).attachText(b, "self.label = type(mine) .. type(string.rep)", "other", false);
  CHECK(b.label == "nilfunction");
}

TEST_CASE("the random numbers of an untrusted script depend on the kernel's seed") {
  const auto draw = [](std::uint64_t seed) {
    LuaHost h;
    h.kernel.setSeed(seed);
    CHECK(sandbox(h, "self.mass = math.random()") == "");
    return h.kernel.root().find<Thing>("/usr/a")->mass;
  };
  CHECK(draw(3) == draw(3));
  CHECK(draw(3) != draw(4));
}

TEST_CASE("an untrusted script ends with its node") {
  LuaHost h;
  CHECK(sandbox(h, "on('tick', function() self.count = self.count + 1 end)") == "");
  h.run("delete('/usr/a')");
  h.emit("tick");
  CHECK(h.kernel.events().channel("tick").empty());
  CHECK(h.text == "");
}
