// The rules that make two runs identical.
#include <set>

#include "lua_fixture.h"
#include "spark/script_server.h"
#include "spark/state.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;

TEST_CASE("pairs iterates in the order of keys: numbers, strings, booleans, then nodes by age") {
  LuaHost h;
  h.thing("/usr/second");
  h.thing("/usr/a");
  CHECK(h.run("local t = {z = 1, [10] = 1, a = 1, [-2] = 1, [2.5] = 1, [true] = 1, [false] = 1, [get('/usr/a')] = 1, "
              "[get('/usr/second')] = 1}\n"
              "local k = {} for key, value in pairs(t) do k[#k + 1] = key end return k") ==
        Value(List{-2, 2.5, 10, "a", "z", false, true, "/usr/second", "/usr/a"}));
}

TEST_CASE("pairs tolerates changes of the table, and skips removed and added keys") {
  LuaHost h;
  CHECK(h.run("local t, k = {a = 1, b = 2, c = 3}, {} for key in pairs(t) do k[#k + 1] = key t.b = nil t['x' .. key] = "
              "1 end return k") == Value(List{"a", "c"}));
}

TEST_CASE("pairs uses __pairs, and refuses keys that have no order") {
  LuaHost h;
  CHECK(h.run("local t = setmetatable({}, {__pairs = function() return function(_, k) if not k then return 1, 2 end "
              "end end}) for k, v in pairs(t) do return {k, v} end") == Value(List{1, 2}));
  CHECK_THAT(h.failure("for k in pairs({[{}] = 1}) do end"),
             Contains("cannot go through this table: a key is a table, which has no order"));
  CHECK_THAT(h.failure("for k in pairs(get('/usr')) do end"),
             Contains("pairs expected a table, found a node: use ipairs(node:children())"));
}

TEST_CASE("next iterates in the order of keys too") {
  LuaHost h;
  CHECK(h.run("local t, k = {c = 3, [1] = 'x', b = 2}, {} local key, value = next(t) while key do k[#k + 1] = {key, "
              "value} key, value = next(t, key) end return k") ==
        Value(List{List{1, "x"}, List{"b", 2}, List{"c", 3}}));
  CHECK(h.run("return next({}) == nil") == Value(true));
}

TEST_CASE("table.sort sorts and is stable") {
  LuaHost h;
  CHECK(
      h.run(
          "local t = {} for i = 1, 500 do t[i] = {i % 3, i} end table.sort(t, function(a, b) return a[1] < b[1] end)\n"
          "for i = 2, 500 do local a, b = t[i - 1], t[i] if a[1] > b[1] or (a[1] == b[1] and a[2] > b[2]) then return "
          "i end end return 'stable'") == Value("stable"));
  CHECK(h.run("local t = {3, 1, 2} table.sort(t) return t") == Value(List{1, 2, 3}));
  CHECK(h.run("local t = {} table.sort(t) return t") == Value(List{}));
  CHECK_THAT(h.failure("table.sort({1, 'a'})"), Contains("attempt to compare"));
}

TEST_CASE("random numbers depend on the kernel's seed, with one stream for each script") {
  const auto draw = [](std::uint64_t seed) {
    LuaHost h;
    h.kernel.setSeed(seed);
    scripts(h.kernel).attachText(h.thing("/usr/a"), "self.anything = {math.random(), math.random(6), math.random(0)}",
                                 "script", true);
    return Value(
        List{h.run("return {math.random(), math.random(1, 1000000)}"), h.run("return get('/usr/a').anything")});
  };
  const Value once = draw(5);
  CHECK(once == draw(5));
  CHECK_FALSE(once == draw(6));
  CHECK_FALSE(*once.at(std::size_t{0})->at(std::size_t{0}) == *once.at(std::size_t{1})->at(std::size_t{0}));
}

TEST_CASE("a script's random numbers do not depend on the draws of other scripts") {
  const auto draw = [](bool other) {
    LuaHost h;
    if (other) scripts(h.kernel).attachText(h.thing("/usr/other"), "math.random()", "script", true);
    return h.run("return math.random()");
  };
  CHECK(draw(false) == draw(true));
}

TEST_CASE("math.random stays within its range, and randomseed repeats the sequence") {
  LuaHost h;
  std::set<std::int64_t> seen;
  for (int i = 0; i < 300; ++i) seen.insert(h.run("return math.random(3, 5)").toInteger());
  CHECK(seen == std::set<std::int64_t>{3, 4, 5});
  CHECK(h.run("for i = 1, 1000 do local r = math.random() if r < 0 or r >= 1 then return r end end return 'ok'") ==
        Value("ok"));
  CHECK(h.run("math.randomseed(7) local a = math.random() math.randomseed(7) return a == math.random()") ==
        Value(true));
  CHECK(h.run("return math.type(math.random(math.mininteger, math.maxinteger))") == Value("integer"));
  CHECK_THAT(h.failure("math.random(2, 1)"), Contains("interval is empty"));
}

TEST_CASE("a script whose node is deleted has no random stream") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  CHECK_THAT(LuaHost::errorOf([&] { scripts(h.kernel).attachText(a, "self:delete() math.random()", "script", true); }),
             Contains("math.random has no stream: the script's node is gone"));
}

TEST_CASE("no conversion to text shows an address") {
  LuaHost h;
  CHECK(h.run("return {tostring({}), tostring(print), tostring(coroutine.create(print)), string.format('%s %5s %d', "
              "{}, print, 3), ('%s'):format({})}") ==
        Value(List{"table", "function", "thread", "table function 3", "table"}));
  CHECK(h.run("return tostring(setmetatable({}, {__tostring = function() return 'mine' end}))") == Value("mine"));
  CHECK(h.run("return string.format('%5.1f%%|%s', 2.25, nil)") == Value("  2.2%|nil"));
  CHECK_THAT(h.failure("return ('%p'):format({})"), Contains("string.format knows no %p here"));
  CHECK_THAT(h.failure("return string.format('%-10p', {})"), Contains("string.format knows no %p here"));
}

TEST_CASE("scripts have no access to files, clocks or bytecode") {
  LuaHost h;
  CHECK(h.run("local found = {} for _, n in ipairs{'os', 'io', 'debug', 'package', 'require', 'dofile', 'loadfile', "
              "'load', 'collectgarbage', 'warn'} do\n"
              "if _G[n] ~= nil then found[#found + 1] = n end end return found") == Value(List{}));
  CHECK(h.run("return {string.dump, ('').dump}") == Value(List{}));
}

TEST_CASE("metatables cannot observe the garbage collector") {
  LuaHost h;
  CHECK_THAT(h.failure("setmetatable({}, {__gc = print})"), Contains("a metatable must not have __gc"));
  CHECK_THAT(h.failure("setmetatable({}, {__mode = 'k'})"), Contains("a metatable must not have __mode"));
  CHECK(h.run("return setmetatable({}, {__index = function() return 5 end}).x") == Value(5));
}

TEST_CASE("a script cannot modify the libraries that all scripts share") {
  LuaHost h;
  CHECK(h.run("return {getmetatable(''), getmetatable(get('/'))}") == Value(List{"string", "node"}));
  scripts(h.kernel).attachText(h.thing("/usr/a"), "string.rep = nil pairs = nil math.floor = nil", "script", true);
  CHECK(h.run("return {('x'):rep(2), string.rep('y', 2), math.floor(1.5), type(pairs)}") ==
        Value(List{"xx", "yy", 1, "function"}));
}

// ---- state ----

namespace {
std::string savedScripts(LuaHost& h) {
  StateWriter out(true);
  saveTree(h.kernel.root(), out);
  return out.bytes();
}
void loadScripts(LuaHost& h, const std::string& bytes) {
  StateReader in(bytes);
  loadTree(h.kernel.root(), in);
  CHECK(in.atEnd());
}
/// A host with two scripts that count.
struct Counters : LuaHost {
  Counters() {
    thing("/usr/a");
    thing("/usr/b");
    write("count.lua",
          "state.seen = {}\nlocal seen = state.seen\nstate.n = 0\n"
          "on('count', function(self) state.n = state.n + 1 seen[state.n] = math.random(1000) "
          "self.anything = {state.n, seen[state.n], #seen} end)");
    run("get('/usr/a'):attachScript('count.lua') get('/usr/b'):attachScript('count.lua')");
  }
  Value count() {
    emit("count");
    return run("return {get('/usr/a').anything, get('/usr/b').anything}");
  }
};
}  // namespace

TEST_CASE("A script's table `state` and its random numbers are state") {
  Counters one, two;
  CHECK(one.count() == two.count());
  one.count();
  CHECK(savedScripts(one) != savedScripts(two));
  const std::string saved = savedScripts(one);
  const Value next = one.count();
  // Into another kernel, and back in the same one: tables that a script holds stay its tables.
  for (Counters* c : {&two, &one}) {
    loadScripts(*c, saved);
    CHECK(savedScripts(*c) == saved);
    CHECK(c->count() == next);
  }
}

TEST_CASE("State of scripts: all kinds of keys and values come back") {
  LuaHost one, two;
  for (LuaHost* h : {&one, &two}) {
    h->thing("/usr/a");
    h->run("state = {}");
  }
  one.run(
      "state = {1, 2.5, 'x', true, {deep = {er = false}}, [-3] = 'minus', [0.5] = 'half', [true] = 'yes', node = "
      "get('/usr/a'), big = 2^53 | 1}");
  loadScripts(two, savedScripts(one));
  CHECK(savedScripts(two) == savedScripts(one));
  CHECK(two.run("return {state[1], state[2], state[3], state[4], state[5].deep.er, state[-3], state[0.5], state[true], "
                "state.node.label, math.type(state[1]), state.big}") ==
        Value(List{1, 2.5, "x", true, false, "minus", "half", "yes", "none", "integer", 9007199254740993}));
  // What was there and is not in the saved state goes.
  two.run("state.more = 1");
  loadScripts(two, savedScripts(one));
  CHECK(two.run("return state.more == nil") == Value(true));
}

TEST_CASE("State of scripts that cannot be saved is named once, and is left out") {
  LuaHost h;
  h.run("state.list = {1, {f = function() end}}");
  const std::string saved = savedScripts(h);
  savedScripts(h);
  CHECK_THAT(h.text, Contains("state.list.2.f is a function; expected a number, text, boolean, table or node"));
  CHECK(h.text.find("cannot be saved") == h.text.rfind("cannot be saved"));
  loadScripts(h, saved);
  CHECK(h.run("return state.list[1]") == Value(1));
  h.run("state.list = nil state.me = state");
  savedScripts(h);
  h.run("state = 7");
  CHECK(savedScripts(h) != saved);
}

TEST_CASE("Saved state of other scripts is refused, hostile bytes too") {
  Counters one;
  LuaHost none;
  none.thing("/usr/a"), none.thing("/usr/b");
  none.run("return 1");
  const std::string saved = savedScripts(one), other = savedScripts(none);
  StateReader in(saved);
  CHECK_THROWS_WITH(loadTree(none.kernel.root(), in), Contains("expected the state of"));
  for (std::size_t i = 0; i < saved.size(); i += 8) {
    std::string bad = saved;
    bad[i] = static_cast<char>(bad[i] ^ 0x5a), bad[i + 7] = static_cast<char>(bad[i + 7] ^ 0x40);
    Counters victim;
    StateReader reader(bad);
    try {
      loadTree(victim.kernel.root(), reader);
    } catch (const Error&) {
    }
    victim.count();
  }
}

TEST_CASE("Scripts whose node is gone have no state") {
  Counters h;
  const auto size = savedScripts(h).size();
  h.run("get('/usr/b'):attachScript('count.lua')");
  CHECK(savedScripts(h).size() > size);
  h.run("delete('/usr/b')");
  CHECK(savedScripts(h).size() < size);
}
