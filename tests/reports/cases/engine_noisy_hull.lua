-- row: 3
-- input: a puck, the hull of 48 points on two circles and many within 1e-7 m of their planes, falls on the ground
-- right: it lies flat, and stdout has JSON lines only
-- engines: OdeEngine ArticulatedEngine BulletEngine
-- args: --duration 1
-- never: warning
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false
local place = new("Transform", "/usr/scene/space/puck")
place.localPos = { 0, 0, 0.08 }
local body = place:new("RigidBody", "body")
body:setCylinderTotal(0.5, 0.1, 0.06)
-- Numbers that only look random.
local seed = 7
local function noise()
  seed = (seed * 16807) % 2147483647
  return seed / 2147483647 - 0.5
end
local points = {}
local function add(radius, angle, z)
  for _, v in ipairs{ radius * math.cos(angle), radius * math.sin(angle), z + 4e-7 * noise() } do
    points[#points + 1] = v
  end
end
for _, z in ipairs{ -0.03, 0.03 } do
  for i = 1, 24 do add(0.1 + 1e-7 * noise(), i * math.pi / 12, z) end
  for _ = 1, 60 do add(0.1 * math.sqrt(noise() + 0.5), 2 * math.pi * noise(), z) end
end
local hull = place:new("ConvexCollider", "hull")
hull.vertices = points
hull:new("ContactJointHandler", "surface").contactBounceMode = false
on("sense", function(_, event)
  if event.cycle ~= 45 then return end
  near("the puck's height", body.position[3], 0.03, 0.004)
  judge("it lies still", math.abs(body.velocity[3]) < 0.05)
end)
