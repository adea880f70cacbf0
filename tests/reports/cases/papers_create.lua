-- row: p77
-- input: an agent creates in four cycles, twice in one of them; another one's effector has a limit of 2
-- right: five and two are made
-- args: --duration 0.6 --agent-port 0
-- expect: create: expected at most 2 imports, found a request for one more
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() agents{} plugin "effectors"
local function maker(name, limit)
  local a = new("Transform", "/usr/scene/" .. name):new("AgentAspect", "agent")
  local create = a:new("CreateEffector", "make")
  create.scene, create.limit = "rsg/agent/papers_bare.rsg", limit
  a:new("ScriptBehavior", "mind"):on("think", function(self, event)
    local asks = event.cycle % 5 == 0 and event.cycle < 25
    self.actions = not asks and "" or event.cycle == 10 and "(create)(create)" or "(create)"
  end)
  return a
end
local free, limited = maker("free", 0), maker("limited", 2)
local function count(a)
  local n = 0
  for _, child in ipairs(a:children()) do if child.name == "bare" then n = n + 1 end end
  return n
end
on("rule", function(self, event)
  if event.cycle ~= 28 then return end
  near("made freely", count(free), 5, 0)
  near("made with a limit", count(limited), 2, 0)
end)
