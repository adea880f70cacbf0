-- row: 4
-- input: a link of 2e-6 kg m^2 with a rotor of 0.01 kg m^2 follows a servo of 30 Nm/rad and 0.6 N m s/rad, in steps
--   of 2 ms
-- right: it is at its target of 0.5 rad after 1 s, and at half of it when the rotor is
-- engines: all
-- args: --duration 1.2
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.002)
get("/usr/scene/world").gravity = { 0, 0, 0 }
local base = new("Transform", "/usr/scene/base")
lightLink(base, "link", 0.01, 0.01, 1e-6)
local hinge = lightHinge(base, "link")
hinge:setArmature(0, 0.01)
hinge:setController(0, 30, 0.6, 0.5, 0, 0, 1000)
-- 30 Nm/rad, 0.010002 kg m^2: 54.8 rad/s, a damping ratio of 0.548; the first overshoot is 12.8 % after 68.5 ms.
once(sim, 0.068, function() near("the angle at its peak", math.rad(hinge:getAngle()), 0.564, 0.03) end)
once(sim, 1, function() near("the angle after 1 s", math.rad(hinge:getAngle()), 0.5, 0.001) end)
