-- row: p82
-- input: a rule has perceptors, effectors and a mind below it; another one asks its perceptor in judge
-- right: the mind hears what they sense and disqualifies; rules are no agents among agents; what has no mind is said
-- args: --duration 0.6 --agent-port 0
-- expect: Agent 1 is disqualified: it is too far out.
-- expect: /sys/server/gamecontrol/idle/flag (DisqualifyEffector) is never used
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
get("/usr/scene/world").gravity = { 0, 0, 0 }
for i, x in ipairs{ 9, 1 } do
  local t = new("Transform", "/usr/scene/runner" .. i)
  t.localPos = { x, 0, 0 }
  local a = t:new("AgentAspect", "agent")
  a:new("TimePerceptor", "time")
  a:new("ScriptBehavior", "mind"):on("think", function() end)
end
local referee = control:new("ScriptAspect", "referee")
referee:new("PerfectVisionPerceptor", "all")
referee:new("DisqualifyEffector", "flag")
local thoughts = 0
referee:new("ScriptBehavior", "mind"):on("think", function(self, event)
  thoughts = thoughts + 1
  for _, percept in ipairs(event.data) do
    for i = 2, #percept do
      local number = percept[i][1]:match("^runner(%d)")
      if number and percept[i][2][2] > 5 and event.cycle > 10 then
        self.actions = "(disqualify " .. number .. " it is too far out)"
      end
    end
  end
end)
local asking = control:new("ScriptAspect", "asking")
asking:new("TimePerceptor", "clock")
local asked
asking:on("judge", function(self, event) asked = self:find("clock"):sense()[1] asked.now = event.time end)
control:new("ScriptAspect", "idle"):new("DisqualifyEffector", "flag")
on("rule", function(self, event)
  if event.cycle ~= 28 then return end
  judge("a rule is an agent aspect", referee:isA("AgentAspect"))
  judge("its mind thinks in every cycle", thoughts > 20)
  judge("the far one is disqualified, the near one stays",
    not get("/usr/scene/runner1/agent") and get("/usr/scene/runner2/agent"))
  judge("the rule is not listed, and its number is 0",
    table.concat(control:agents(), " ") == "/usr/scene/runner2/agent" and referee.number == 0)
  judge("a rule asks its perceptor", asked[1] == "time" and asked[2][2] == asked.now)
end)
