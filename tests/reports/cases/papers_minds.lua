-- row: p23
-- input: an object with nothing but a mind, one in a scene that is not active, and minds in wrong places
-- right: both think in each cycle; a mind that drives nothing is named with what was expected
-- args: --duration 0.5 --agent-port 0
-- expect: /usr/scene/lost (ScriptBehavior) drives nothing: expected it below /usr/agent
-- expect: /usr/scene/thinker/agent/second (ScriptBehavior) drives nothing
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control, thoughts, seen = agents{}, {}, {}
local function mind(path)
  thoughts[path] = 0
  new("ScriptBehavior", path):on("think", function(self, event)
    thoughts[path] = thoughts[path] + 1
    for _, p in ipairs(event.data) do seen[path] = p end
  end)
end
new("Transform", "/usr/scene/thinker"):new("AgentAspect", "agent")
mind("/usr/scene/thinker/agent/mind")
mind("/usr/scene/thinker/agent/second")
mind("/usr/scene/lost")
new("Scene", "/usr/other")
new("Transform", "/usr/other/far"):new("AgentAspect", "agent"):new("PerfectVisionPerceptor", "all")
mind("/usr/other/far/agent/mind")
on("rule", function(self, event)
  if event.cycle ~= 22 then return end
  judge("a mind alone thinks", thoughts["/usr/scene/thinker/agent/mind"] > 15)
  judge("one of another scene thinks", thoughts["/usr/other/far/agent/mind"] > 15)
  local names = {}
  local far = seen["/usr/other/far/agent/mind"] or {}
  for i = 2, #far do names[#names + 1] = far[i][1] end
  judge("and sees its own scene: " .. table.concat(names, " "), table.concat(names, " ") == "far agent")
  judge("two agents", control.agentCount == 2)
  judge("the others do not think", thoughts["/usr/scene/lost"] + thoughts["/usr/scene/thinker/agent/second"] == 0)
end)
