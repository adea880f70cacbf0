-- row: p66
-- input: a rule makes a robot that is a body alone, without a perceptor or an effector; its mind asks for both
-- right: the mind is called with empty percepts, gets what it asked for, and uses it; without a robot it is not called
-- args: --duration 0.6 --agent-port 0
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() agents{} plugin "sensors" plugin "effectors"
local control = get("/sys/server/gamecontrol")
control.requests = true
get("/usr/scene/world").gravity = { 0, 0, 0 }
local body
control:new("ScriptAspect", "rule"):on("agentConnected", function(self, event)
  if body then return end
  body = get(event.data):new("RigidBody", "body")
  body:setSphereTotal(1, 0.1)
end)
local calls, heard, bare = 0, {}, 0
new("ScriptBehavior", "/usr/agent/asks"):on("think", function(self, event)
  calls = calls + 1
  self.actions = "(force 1 0 0)"
  if calls == 3 then
    self.actions = "(request (perceptor GPS) (name gps))(request (effector ForceEffector) (name push))"
  end
  for _, percept in ipairs(event.data) do heard[percept[1]] = true end
end)
new("ScriptBehavior", "/usr/agent/none"):on("think", function() bare = bare + 1 end)
on("rule", function(self, event)
  if event.cycle ~= 25 then return end
  judge("the mind is called: " .. calls, calls > 15)
  judge("what it asked for is granted", heard.granted)
  judge("it senses", heard.GPS)
  judge("it moves", body.velocity[1] > 0.05)
  judge("without a robot the mind is not called: " .. bare, bare == 0)
end)
