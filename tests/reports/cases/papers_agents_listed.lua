-- row: pF2
-- input: a script asks game control for its agents, disqualifies one by its path and removes one by its number
-- right: all are listed in order of number, the two leave, and a wrong name is an error that lists those that are there
-- args: --duration 0.4 --agent-port 0
-- expect: Agent 2 is disqualified: it dived.
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors"
local control = agents{}
for i = 1, 3 do
  local a = new("Transform", "/usr/scene/o" .. i):new("AgentAspect", "agent")
  a:new("ScriptBehavior", "mind"):on("think", function() end)
end
local function listed() return table.concat(control:agents(), " ") end
on("rule", function(self, event)
  if event.cycle == 5 then
    judge("all are listed", listed() == "/usr/scene/o1/agent /usr/scene/o2/agent /usr/scene/o3/agent")
    control:disqualify("/usr/scene/o2/agent", "it dived")
    control:removeAgent(3)
    local good, why = pcall(function() control:disqualify(7, "it is not there") end)
    judge("a wrong one is an error: " .. tostring(why):sub(1, 90),
      not good and why:find("there are 1 /usr/scene/o1/agent", 1, true))
  elseif event.cycle == 8 then
    judge("one stays", listed() == "/usr/scene/o1/agent")
  end
end)
