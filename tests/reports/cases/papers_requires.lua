-- row: pF8
-- input: agents ask at their start for what exists and for what a rule refuses; one asks later; with the switch off
-- right: who requires what is refused does not take part and acts never; a later refusal costs only the part
-- args: --duration 0.8 --agent-port 0
-- expect: does not take part: it requires GyroRatePerceptor, which is refused: the rules do not allow GyroRatePerceptor.
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
get("/usr/scene/world").gravity = { 0, 0, 0 }
local rule = control:new("RequestAspect", "rule")
rule.allowed = { "GPS", "rsg/agent/papers_cart.rsg" }
local good, bad = "(request (perceptor GPS) (name one))", "(request (perceptor GyroRatePerceptor) (name two))"
local told = {}
local function mind(name, path, start, later)
  local m = new("ScriptBehavior", path)
  m:on("start", function(self) self.actions = start end)
  m:on("think", function(self, event)
    self.actions = "(force 1 0 0)" .. (event.cycle == 12 and later or "")
    for _, p in ipairs(event.data) do if p[1] == "refused" then told[name] = true end end
  end)
end
local function object(name, start, later)
  local t = new("Transform", "/usr/scene/" .. name)
  t:new("RigidBody", "body"):setSphereTotal(1, 0.1)
  t:new("AgentAspect", "agent"):new("ForceEffector", "legs")
  mind(name, "/usr/scene/" .. name .. "/agent/mind", start, later)
end
object("happy", good, "")
object("later", good, bad)
object("wants", good .. bad, "")
mind("robot", "/usr/agent/robot", "(scene rsg/agent/papers_cart.rsg)" .. bad, "")
on("rule", function(self, event)
  if event.cycle == 20 then
    local v = function(name) return get("/usr/scene/" .. name .. "/body").velocity[1] end
    judge("granted: takes part", v("happy") > 0.1)
    judge("refused later: takes part", v("later") > 0.1 and told.later)
    judge("refused at the start: an object again, which never acted",
      v("wants") == 0 and not get("/usr/scene/wants/agent"))
    judge("and was told", told.wants and told.robot)
    judge("a robot that requires more: gone", not get("/usr/scene/AgentAspect4"))
    judge("two take part", control.agentCount == 2)
    control.requireAll = false
    object("content", good .. bad, "")
  elseif event.cycle == 36 then
    judge("requireAll = false: takes part without it",
      get("/usr/scene/content/body").velocity[1] > 0.1 and told.content)
  end
end)
