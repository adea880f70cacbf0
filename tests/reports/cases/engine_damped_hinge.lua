-- row: 4
-- input: a link of 0.2 kg, 1.3e-3 kg m^2 about its hinge, sinks against a damping of 0.5 N m s/rad, in steps of 20 ms
-- right: 0.0627 rad after 0.2 s: its rate is that of the damper from the first step on
-- engines: all
-- args: --duration 0.3
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.02)
local base = new("Transform", "/usr/scene/base")
lightLink(base, "link", 0.2, 0.08, 2e-5)
local hinge = lightHinge(base, "link")
hinge:setDamping(0, 0.5)
-- Without inertia: rate = m g l cos(angle) / damping.
once(sim, 0.2, function() near("the angle after 0.2 s", math.rad(hinge:getAngle()), 0.0627, 0.0015) end)
