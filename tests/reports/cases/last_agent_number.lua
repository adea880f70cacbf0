-- row: pF2
-- input: a script disqualifies and removes agents by numbers that it has computed: 4 / 2, and 3.0
-- right: numbers count by their value: agents 2 and 3 leave; 1.5 is an error that lists those that are there
-- args: --duration 0.3 --agent-port 0
-- expect: Agent 2 is disqualified: it dived.
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation()
local control = agents{}
for i = 1, 3 do
  local aspect = new("Transform", "/usr/scene/o" .. i):new("AgentAspect", "agent")
  aspect:new("ScriptBehavior", "mind"):on("think", function() end)
end
on("rule", function(self, event)
  if event.cycle == 5 then
    judge("4 / 2 is an agent", pcall(function() control:disqualify(4 / 2, "it dived") end))
    judge("3.0 is an agent", pcall(function() control:removeAgent(3.0) end))
    local good, why = pcall(function() control:removeAgent(1.5) end)
    judge("1.5 is none: " .. tostring(why):sub(1, 90), not good and why:find("found '1.5'", 1, true))
  elseif event.cycle == 8 then
    judge("one stays", table.concat(control:agents(), " ") == "/usr/scene/o1/agent")
  end
end)
