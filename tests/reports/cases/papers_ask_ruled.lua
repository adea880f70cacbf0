-- row: p66
-- input: agents whose robots a rule makes, and one whose rule makes none, ask for a sensor and an effector
-- right: the robots get both and use them; without a robot nothing is granted, and the agent is told why
-- args: --duration 0.6 --agent-port 0
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() agents{} plugin "sensors" plugin "effectors"
get("/sys/server/gamecontrol").requests = true
get("/usr/scene/world").gravity = { 0, 0, 0 }
local heard = { loaded = {}, built = {}, none = {} }
local order = { "loaded", "built", "none" }
local number, bodies = 0, {}
new("ScriptAspect", "/sys/server/gamecontrol/rule"):on("agentConnected", function(self, event)
  number = number + 1
  local place = get(event.data)
  if order[number] == "loaded" then
    place:importScene("rsg/agent/papers_cart.rsg")
    bodies.loaded = place:find("cart/body")
  end
  if order[number] == "built" then
    bodies.built = place:new("RigidBody", "body")
    bodies.built:setSphereTotal(1, 0.1)
    place:new("TimePerceptor", "time")
  end
end)
for _, name in ipairs(order) do
  local at = name == "loaded" and "(at body)" or ""
  new("ScriptBehavior", "/usr/agent/" .. name):on("think", function(self, event)
    self.actions = ""
    if event.cycle > 12 then self.actions = "(force 1 0 0)" end
    if event.cycle == 8 then
      self.actions = "(request (perceptor GPS) (name gps))(request (effector ForceEffector) (name more) " .. at .. ")"
    end
    for _, percept in ipairs(event.data) do
      heard[name][percept[1] .. (percept[2] and percept[2][2] or "")] = percept
    end
  end)
end
-- without a robot an agent has no percepts, so this one asks at once
get("/usr/agent/none"):on("start", function(self) self.actions = "(request (perceptor GPS) (name gps))" end)
on("rule", function(self, event)
  if event.cycle ~= 28 then return end
  for _, name in ipairs{ "loaded", "built" } do
    judge(name .. ": the sensor is granted and senses", heard[name].grantedgps and heard[name].GPSgps)
    judge(name .. ": the effector is granted", heard[name].grantedmore)
    judge(name .. ": the effector drives it", bodies[name].velocity[1] > 0.1)
  end
  local why = heard.none.refusedgps and table.concat(heard.none.refusedgps[3], " ") or "nothing"
  judge("none: refused, " .. why, why:find("there is no robot yet"))
end)
