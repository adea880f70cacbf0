-- row: 13
-- input: a free bar is turned by a torque without gravity; an accelerometer is at its end
-- right: it feels the tangential acceleration at once
-- engines: all
-- args: --duration 0.5
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics(engineOption()) simulation() agents{ port = 0 }
plugin "sensors"
get("/usr/scene/world").gravity = { 0, 0, 0 }
local bar = new("Transform", "/usr/scene/bar")
local body = bar:new("RigidBody", "body")
body:setMassParameters(2, 0, 0, 0, 0.5, 0.5, 0.5, 0, 0, 0)
local agent = bar:new("AgentAspect", "agent")
local tip = agent:new("Transform", "tip")
tip.localPos = { 0.8, 0, 0 }
tip:new("Accelerometer", "tip")
on("prepare", function() body:addTorque(0, 0, 1.5) end)  -- 3 rad/s^2
watch(agent, function(seen, time)
  if isAt(time, 0.1) then near("the tangential acceleration", seen["ACC tip"][3][3], 2.4, 0.05) end
end)
