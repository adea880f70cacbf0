-- row: p23
-- input: the minds of an object, of a rule, and of an object that may ask are deleted; others come later; an object's
--    agent is disqualified
-- right: what a mind drove keeps its parts, is no agent, and thinks again with the next mind; the disqualified one is
--    an object again
-- args: --duration 0.8 --agent-port 0
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
local thoughts = {}
local function mind(above, name)
  thoughts[name] = 0
  local b = above:new("ScriptBehavior", name)
  b:on("think", function(self, event)
    thoughts[name] = thoughts[name] + 1
    self.actions = event.cycle % 10 == 2 and "(request (perceptor GPS) (name more))" or ""
  end)
  return b
end
local function object(name)
  local aspect = new("Transform", "/usr/scene/" .. name):new("AgentAspect", "agent")
  aspect:new("GPS", "gps")
  return aspect
end
local thing, other = object("thing"), object("other")
local rule = control:new("ScriptAspect", "rule")
rule:new("GPS", "gps")
local first, ruler = mind(thing, "first"), mind(rule, "ruler")
mind(other, "else")
on("rule", function(self, event)
  if event.cycle == 12 then
    first:delete()
    ruler:delete()
  elseif event.cycle == 16 then
    judge("the aspect stays, with its perceptors",
      get("/usr/scene/thing/agent/gps") and get("/usr/scene/thing/agent/more"))
    judge("without what game control gave it", not get("/usr/scene/thing/agent/_Request"))
    judge("it is no agent", thing.number == 0 and control.agentCount == 1)
    judge("the rule stays", get("/sys/server/gamecontrol/rule/gps"))
    mind(thing, "second")
    mind(rule, "ruler2")
  elseif event.cycle == 26 then
    judge("the next mind thinks", thoughts.second > 5 and control.agentCount == 2)
    judge("that of the rule, too", thoughts.ruler2 > 5)
    judge("its agent has a number of its own: " .. thing.number, thing.number == 3)
    control:disqualify(thing.number, "it is done")
  elseif event.cycle == 30 then
    judge("the disqualified one is an object", get("/usr/scene/thing") and not get("/usr/scene/thing/agent"))
    judge("the others go on", thoughts["else"] > 20)
  end
end)
