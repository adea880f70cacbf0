-- row: 5
-- input: three actuators of one joint, each with a force range of its own, symmetric or not
-- right: each force stays in its own range: the joints turn with -1.5, -1.25 and -1.5 rad/s^2
-- engines: all
-- args: --duration 0.5
-- never: warning
include "house.lua"
include "../lib/judge.lua"
files() scene() physics(engineOption())
plugin "gamecontrol"
plugin "effectors"
simulation()
get("/usr/scene"):importScene("mjcf_force_ranges.xml")
local function joint(name) return get("/usr/scene/wheels/" .. name .. "/" .. name) end
local acceleration = { left = -1.5, right = -1.25, lone = -1.5 }
on("rule", function(_, event)
  if math.abs(event.time - 0.4) > 0.001 then return end
  for name, a in pairs(acceleration) do
    near("the angle of '" .. name .. "'", math.rad(joint(name):getAngle()), a * 0.4 ^ 2 / 2, 0.02)
  end
end)
