-- row: 4
-- input: a servo of at most 1 Nm, 400 Nm/rad and 20 N m s/rad, holds 1 kg on an arm of 0.2 m, which takes 1.96 Nm
-- right: the arm falls with the acceleration that 0.96 Nm give: 0.0479 rad after 0.1 s
-- engines: all
-- args: --duration 0.3
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.005)
local base = new("Transform", "/usr/scene/base")
lightLink(base, "link", 1, 0.2, 0.06)
local hinge = lightHinge(base, "link")
hinge:setController(0, 400, 20, 0, 0, 0, 1)
-- Inertia 0.1 kg m^2; the servo is at its bound from the second step on.
once(sim, 0.1, function() near("the angle after 0.1 s", math.rad(hinge:getAngle()), 0.048, 0.009) end)
