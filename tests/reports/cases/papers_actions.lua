-- row: p83
-- input: a rule in Lua hears of each action, and refuses those with a force above 1 N
-- right: weak pushes act, strong ones do not, and the log names the agent and the reason
-- args: --duration 0.4 --agent-port 0
-- expect: force: refused: at most 1 N.
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "effectors"
local control = agents{}
get("/usr/scene/world").gravity = { 0, 0, 0 }
local rule, heard = control:new("ScriptAspect", "rule"), {}
rule:on("action", function(self, event)
  local agent, action = table.unpack(event.data)
  heard[agent] = action[1]
  if action[2] > 1 then return "at most 1 N" end
end)
local bodies = {}
for name, force in pairs{ weak = 1, strong = 2 } do
  local object = new("Transform", "/usr/scene/" .. name)
  bodies[name] = object:new("RigidBody", "body")
  bodies[name]:setSphereTotal(1, 0.1)
  local aspect = object:new("AgentAspect", "agent")
  aspect:new("ForceEffector", "legs")
  aspect:new("ScriptBehavior", "mind"):on("think", function(self) self.actions = "(force " .. force .. " 0 0)" end)
end
on("rule", function(self, event)
  if event.cycle ~= 18 then return end
  judge("the weak one moves", bodies.weak.velocity[1] > 0.1)
  judge("the strong one does not", bodies.strong.velocity[1] == 0)
  local weak, strong = heard["/usr/scene/weak/agent"], heard["/usr/scene/strong/agent"]
  judge("the rule heard both", weak == "force" and strong == "force")
end)
