-- row: 2
-- input: a hull, the corners of a cube, begins on a box so that their faces touch exactly, in numbers without rounding
-- right: it rests there, and nothing fails
-- engines: all
-- args: --duration 1.1
-- never: ODE failed
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption())
local sim = simulation()
sim.step = 0.005
local space = get("/usr/scene/space")
local floor = new("Transform", "/usr/scene/space/floor")
floor.localPos = { 0, 0, -0.125 }
local slab = floor:new("BoxCollider", "box")
slab.boxLengths = { 2, 2, 0.25 }
slab:new("ContactJointHandler", "surface").contactBounceMode = false
local place = new("Transform", "/usr/scene/space/brick")
place.localPos = { 0.3, 0.3, 0.0625 }
local body = place:new("RigidBody", "body")
body:setBoxTotal(1, 0.125, 0.125, 0.125)
local hull = place:new("ConvexCollider", "hull")
hull.vertices = { -.0625,-.0625,-.0625, -.0625,-.0625,.0625, -.0625,.0625,-.0625, -.0625,.0625,.0625,
                  .0625,-.0625,-.0625, .0625,-.0625,.0625, .0625,.0625,-.0625, .0625,.0625,.0625 }
hull:new("ContactJointHandler", "surface").contactBounceMode = false
on("sense", function(_, event)
  if event.cycle == 200 then near("the brick's height", body.position[3], 0.0625, 0.005) end
end)
