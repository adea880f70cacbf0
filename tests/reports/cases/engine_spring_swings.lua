-- row: 4
-- input: 1 kg m^2 swings on a spring of 40 Nm/rad without damping
-- right: after ten periods it swings as far as before
-- engines: all
-- args: --duration 10.2
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.005)
get("/usr/scene/world").gravity = { 0, 0, 0 }
local base = new("Transform", "/usr/scene/base")
local _, body = lightLink(base, "link", 1, 0, 1)
local hinge = lightHinge(base, "link")
hinge:setSpring(0, 40, 0)
body.angularVelocity = { 0, 1, 0 }
-- 6.325 rad/s, 0.1581 rad.
local most = 0
on("sense", function(_, event)
  if event.time > 9 then most = math.max(most, math.abs(math.rad(hinge:getAngle()))) end
end)
once(sim, 10.1, function() near("how far it swings", most, 0.1581, 0.004) end)
