// Compares find, match, gmatch and gsub of scripts with those of plain Lua.
#include <lua.hpp>

#include "lua_fixture.h"

using namespace spark;
using namespace spark::test;

namespace {
/// A script that runs in both. It draws valid and invalid patterns of all items and returns one line for the result or
/// the error of each call.
const char* kCompare = R"--(
local state = 20261122
local function draw(n)
  state = state * 6364136223846793005 + 1442695040888963407
  return (state >> 33) % n + 1
end
local function oneOf(t) return t[draw(#t)] end

local letters = {"a", "a", "a", "b", "b", "c", "A", "1", " ", "-", "]", "^", "%", ".", "(", ")", "$", "\0", "\n", "\233"}
local function text(longest)
  local t = {}
  for i = 1, draw(longest + 1) - 1 do t[i] = oneOf(letters) end
  return table.concat(t)
end

local singles = {"a", "a", "b", ".", "c", "-", "]", "%a", "%c", "%d", "%g", "%l", "%p", "%s", "%u", "%w", "%x", "%z", "%A", "%C", "%D", "%G", "%L", "%P",
                 "%S", "%U", "%W", "%X", "%Z", "%.", "%%", "%(", "%]", "%-", "[ab]", "[^a]", "[a-c]", "[]]", "[^]]", "[]-a]", "[%a-]", "[a-]", "[-a]",
                 "[%]%-]", "[^%s%d]", "[a%-z]", "[c-a]", "[%a-z]", "[a^]", "[.$]", "[\0-a]", "[a-\233]", "\0", "\233", "%\0", "%\233"}
local suffixes = {"", "", "", "", "*", "+", "-", "?"}
local rare = {"%1", "%1", "%2", "%b()", "%bab", "%baa", "%f[%a]", "%f[^%a]", "%f[\0]", "()", "^", "$", "*", "?"}
local wrong = {"%", "[", "[^", "[a", "[%", "[a-", "[]", "%b", "%ba", "%f", "%fa", "%f[", "%0", "%9", ")", "("}
local function pattern()
  local out, open = draw(8) == 1 and "^" or "", 0
  for _ = 1, draw(5) do
    local kind = draw(40)
    if kind <= 25 then out = out .. oneOf(singles) .. oneOf(suffixes)
    elseif kind <= 29 then out, open = out .. "(", open + 1
    elseif kind <= 32 and open > 0 then out, open = out .. ")", open - 1
    elseif kind <= 39 then out = out .. oneOf(rare)
    else out = out .. oneOf(wrong) end
  end
  if draw(20) > 1 then out = out .. (")"):rep(open) end
  return draw(8) == 1 and out .. "$" or out
end

local replacements = {"", "x", "%0", "<%0>", "%1", "%1-%2", "%%", "%%1", "%2%1%0", "%", "%x", "%9", "a\0b", 7, 1.5, {a = "x", b = false, ab = 3, [1] = "one"},
                      setmetatable({}, {__index = function(t, k) return type(k) == "string" and k:upper() or nil end}), {a = {}},
                      function(...) return select("#", ...) .. tostring((...)) end, function() end, function() return false end, function() return {} end,
                      function(a) return #tostring(a) end, function() error("no") end, true}

local lines, results, failures = {}, 0, 0
local function shown(...)
  local t = table.pack(...)
  for i = 1, t.n do t[i] = type(t[i]) == "table" and "table" or string.format("%q", t[i]):gsub("\n", "n") end
  return table.concat(t, " ", 1, t.n)
end
local function note(what, s, p, ok, ...)
  if not ok then failures = failures + 1 elseif (...) ~= nil and (...) ~= 0 then results = results + 1 end
  lines[#lines + 1] = what .. " of " .. shown(s, p) .. ": " .. (ok and "" or "error ") .. shown(...)
end
local function gathered(s, p, from)
  local t = {}
  for a, b, c in string.gmatch(s, p, from) do
    t[#t + 1] = shown(a, b, c)
    if #t == 30 then break end
  end
  return table.concat(t, ",")
end

for _ = 1, 8000 do
  local s, p = text(10), pattern()
  local from, r, n = draw(30) - 15, oneOf(replacements), draw(4) - 2
  note("find", s, p, pcall(function() local t = table.pack(string.find(s, p)) return table.unpack(t, 1, t.n) end))
  note("find from " .. from, s, p, pcall(function() local t = table.pack(string.find(s, p, from)) return table.unpack(t, 1, t.n) end))
  note("plain find from " .. from, s, p, pcall(function() local t = table.pack(string.find(s, p, from, true)) return table.unpack(t, 1, t.n) end))
  note("match", s, p, pcall(function() local t = table.pack(s:match(p)) return table.unpack(t, 1, t.n) end))
  note("match from " .. from, s, p, pcall(function() local t = table.pack(s:match(p, from)) return table.unpack(t, 1, t.n) end))
  note("gmatch", s, p, pcall(gathered, s, p))
  note("gmatch from " .. from, s, p, pcall(gathered, s, p, from))
  note("gsub by " .. shown(type(r) ~= "function" and r or nil), s, p, pcall(function() local t, k = string.gsub(s, p, r) return t, k end))
  note("gsub, " .. n .. " times", s, p, pcall(function() local t, k = s:gsub(p, r, n) return t, k end))
end

-- Arguments that are not strings, not numbers, or too large.
local f = string
local odd = {
  function() f.find() end, function() f.find("a") end, function() f.find("a", nil) end, function() f.find({}, "a") end, function() f.find("a", "a", "x") end,
  function() f.find("a", "a", 1.5) end, function() return f.find(121, 2) end, function() return f.find(12.5, "%.") end, function() return f.find("a", "", 3) end,
  function() return f.find("a", "", math.mininteger) end, function() return f.find("a", "", math.maxinteger) end, function() f.match() end,
  function() f.match("a") end, function() f.match(true, "a") end, function() f.gmatch() end, function() f.gmatch("a") end, function() f.gmatch("a", {}) end,
  function() f.gmatch("a", "a", "x") end, function() return f.gmatch("12", 1)() end, function() return f.gmatch("abc", "()", -1)() end, function() f.gsub() end,
  function() f.gsub("a") end, function() f.gsub("a", "a") end, function() f.gsub("a", "a", nil) end, function() f.gsub("a", "a", true, "x") end,
  function() f.gsub("a", "a", "b", "x") end, function() f.gsub("a", "a", "b", 0.5) end, function() return f.gsub(1221, 2, 3) end,
  function() return f.gsub("abc", "%w", "%0%0", 2) end, function() return ("a"):rep(40):find(("(a)"):rep(32)) end, function() return ("a"):rep(40):find(("(a)"):rep(33)) end,
  function() return ("a"):rep(300):find(("a?"):rep(199) .. ("a"):rep(100)) end, function() return ("a"):rep(300):find(("a?"):rep(200) .. ("a"):rep(100)) end,
  function() return ("x"):find(("("):rep(199)) end, function() return ("a"):rep(300):match("a-b") end, function() return ("a"):rep(300):match(".-" .. ("a"):rep(300)) end,
  function() return f.gsub("abc", "b", function() return coroutine.running() end) end,
  function() return coroutine.wrap(function() return f.gsub("abc", "b", coroutine.yield) end)() end,
}
for i, call in ipairs(odd) do note("call " .. i, "", "", pcall(call)) end
lines[#lines + 1] = results .. " results, " .. failures .. " errors"
return table.concat(lines, "\n")
)--";

/// The result of the script in plain Lua.
std::string plainly(const char* script) {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), &lua_close);
  lua_State* const L = state.get();
  luaL_openlibs(L);
  REQUIRE(luaL_loadbuffer(L, script, std::strlen(script), "=test") == LUA_OK);
  const int status = lua_pcall(L, 0, 1, 0);
  INFO(lua_tostring(L, -1));
  REQUIRE(status == LUA_OK);
  std::size_t n = 0;
  const char* text = lua_tolstring(L, -1, &n);
  return {text, n};
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}
}  // namespace

TEST_CASE("random patterns give the same results and errors as in plain Lua") {
  LuaHost h;
  const std::vector<std::string> expected = linesOf(plainly(kCompare)), found = linesOf(h.run(kCompare).toString());
  REQUIRE(expected.size() == found.size());
  int differences = 0;
  for (std::size_t i = 0; i < expected.size() && differences < 10; ++i)
    if (found[i] != expected[i]) {
      ++differences;
      CHECK(found[i] == expected[i]);
    }
  CHECK(differences == 0);
  // The script has drawn many patterns of both kinds.
  int results = 0, errors = 0;
  REQUIRE(std::sscanf(expected.back().c_str(), "%d results, %d errors", &results, &errors) == 2);
  CHECK(results > 15'000);
  CHECK(errors > 4'000);
}
