-- row: p77
-- input: an agent whose robot may be created once creates, three times, from a file that fails after its first node
-- right: the log says that a part is created, the part counts as the robot, and another one is refused
-- args: --duration 0.6 --agent-port 0
-- expect: create: only a part is created: rsg/agent/last_half.rsg:3:32
-- expect: create: expected one robot, found a request for another: it has a robot already
-- never: nothing is created
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() agents{} plugin "effectors"
local agent = new("Transform", "/usr/scene/maker"):new("AgentAspect", "agent")
local create = agent:new("CreateEffector", "make")
create.scene, create.limit = "rsg/agent/last_half.rsg", 1
agent:new("ScriptBehavior", "mind"):on("think", function(self, event)
  self.actions = event.cycle % 5 == 0 and event.cycle < 20 and "(create)" or ""
end)
on("rule", function(self, event)
  if event.cycle ~= 28 then return end
  local n = 0
  for _, child in ipairs(agent:children()) do if child.name == "half" then n = n + 1 end end
  near("parts", n, 1, 0)
end)
