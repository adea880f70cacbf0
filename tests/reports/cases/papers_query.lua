-- row: pF9
-- input: minds ask their perceptors when they want to, beside what they get: with noise, with a delay, of a script, of all
-- right: the answer is what is sensed now, asking changes nothing that is sensed later, and a question within one is an error
-- args: --duration 0.6 --agent-port 0
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors" plugin "modifiers"
agents{}
get("/usr/scene/world").gravity = { 0, 0, 0 }
local function object(name)
  local t = new("Transform", "/usr/scene/" .. name)
  local a = t:new("AgentAspect", "agent")
  a:new("GPS", "gps"):new("WhiteNoise", "noise").sigma = 0.1
  a:new("TimePerceptor", "time"):new("Delay", "late").cycles = 3
  local n = 0
  a:new("ScriptPerceptor", "count"):on("perceive", function() n = n + 1 return { n = n } end)
  return a
end
local asks, silent = object("asks"), object("silent")
local clock, sameNoise, times, same = {}, true, 0, true
local received = { asks = {}, silent = {} }
asks:new("ScriptBehavior", "mind"):on("think", function(self, event)
  for _, p in ipairs(event.data) do if p[1] == "time" then received.asks[#received.asks + 1] = p[2][2] end end
  local first, again = asks:find("gps"):sense()[1][3][5], asks:find("gps"):sense()[1][3][5]
  sameNoise = sameNoise and first == again and first ~= 0
  clock = asks:find("time"):sense()
  times = #asks:sense()
end)
silent:new("ScriptBehavior", "mind"):on("think", function(self, event)
  for _, p in ipairs(event.data) do if p[1] == "time" then received.silent[#received.silent + 1] = p[2][2] end end
end)
local nested = true
local idle = new("Transform", "/usr/scene/idle"):new("AgentAspect", "agent") -- of no agent: its script runs when asked
idle:new("ScriptPerceptor", "nosy"):on("perceive", function()
  nested = pcall(function() return asks:find("gps"):sense() end)
end)
on("rule", function(self, event)
  if event.cycle ~= 28 then return end
  judge("noise is that of the moment, twice the same", sameNoise)
  judge("the delay acts on the answer, too", clock[1] == nil or event.time - clock[1][2][2] > 0.05)
  judge("an aspect answers for all its perceptors", times >= 2)
  local wrong = #received.asks ~= #received.silent or #received.asks < 10
  for i, t in ipairs(received.asks) do wrong = wrong or t ~= received.silent[i] end
  judge("what is sensed later is as without questions", not wrong)
  nested = true
  idle:find("nosy"):sense()
  judge("a perceptor that is asked cannot ask", nested == false)
end)
