-- row: pF8
-- input: objects that ask at their start for what is no request, for more than a cycle may have, or for what rules
--    refuse as an action
-- right: each requires what it asks for, is told why it is refused, does not take part, and never acts
-- args: --duration 0.6 --agent-port 0
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
get("/usr/scene/world").gravity = { 0, 0, 0 }
local function ask(name) return "(request (perceptor TimePerceptor) (name " .. name .. "))" end
local many = ""
for i = 1, 20 do many = many .. ask("m" .. i) end
local starts = {
  nameless = "(request (perceptor TimePerceptor))",
  blank = ask('"a b"'),
  path = ask("a/b"),
  many = many,
  barred = ask("barred"),
  limited = ask("one") .. ask("two") .. ask("three"),
  good = ask("one"),
}
local limit = control:new("ActionLimitAspect", "limit")
limit.predicate, limit.perCycle = "request", 2
limit.enabled = false
control:new("ScriptAspect", "rule"):on("action", function(self, event)
  local words = event.data[2]
  if words[1] == "request" and words[3] and words[3][2] == "barred" then return "barred" end
end)
local told, order = {}, {}
for name in pairs(starts) do order[#order + 1] = name end
local function object(name)
  local t = new("Transform", "/usr/scene/" .. name)
  t:new("RigidBody", "body"):setSphereTotal(1, 0.1)
  t:new("AgentAspect", "agent"):new("ForceEffector", "legs")
  local mind = new("ScriptBehavior", "/usr/scene/" .. name .. "/agent/mind")
  mind:on("start", function(self) self.actions = starts[name] end)
  mind:on("think", function(self, event)
    self.actions = "(force 1 0 0)"
    for _, p in ipairs(event.data) do if p[1] == "refused" then told[name] = true end end
  end)
end
for _, name in ipairs(order) do if name ~= "limited" then object(name) end end
on("rule", function(self, event)
  if event.cycle == 8 then
    limit.enabled = true
    object("limited")
  elseif event.cycle == 25 then
    for _, name in ipairs(order) do
      local path = "/usr/scene/" .. name
      local moves, there = get(path .. "/body").velocity[1] ~= 0, get(path .. "/agent")
      if name == "good" then
        judge("what is granted: it takes part", moves and there)
      else
        judge(name .. ": it is told, does not take part and never acts", told[name] and not there and not moves)
      end
    end
  end
end)
