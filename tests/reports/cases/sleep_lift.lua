-- row: 1
-- input: a load rests on the stop of a slider; its motor is switched on at 4 s
-- right: the load rises
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
files() scene() physics(engineOption()) simulation()
local load = crateAt("load", { 0, 0, 2 })
local lift = get("/usr/scene/space/load"):new("SliderJoint", "lift")
lift:attach("../body")
lift:setLocalAxis(0, 0, 0, 1)
lift:setLowStopPos(0, 0)
at(4, function()
  near("the height at rest", load.position[3], 2, 0.02)
  lift:setMaxMotorForce(0, 50)
  lift:setLinearMotorVelocity(0, 0.5)
end)
at(6, function() near("the height of the load", load.position[3], 3, 0.05) end)
