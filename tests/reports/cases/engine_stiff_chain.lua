-- row: 4
-- input: a chain of four links of 10 g from a wall, held by springs of 40 Nm/rad and servos of 60 Nm/rad and 0.3 N m
--   s/rad, in steps of 5 ms
-- right: it bends by less than a hundredth of a radian
-- engines: OdeEngine ArticulatedEngine BulletEngine
-- args: --duration 1.2
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.005)
local place, second = new("Transform", "/usr/scene/base"), nil
local hinges = {}
for i = 1, 4 do
  local tip = lightLink(place, "link", 0.01, 0.03, 2e-6)
  local hinge = lightHinge(place, "link", second)
  if i % 2 == 1 then hinge:setSpring(0, 40, 0); hinge:setDamping(0, 0.05)
  else hinge:setController(0, 60, 0.3, 0, 0, 0, 1000) end
  hinges[i] = hinge
  place, second = tip, "../../body"
end
once(sim, 1, function()
  for i, hinge in ipairs(hinges) do near("the angle of hinge " .. i, math.rad(hinge:getAngle()), 0, 0.01) end
end)
