-- row: 1
-- input: a crate rests on a ground of heights, which sinks by 1 m at 4 s
-- right: the crate falls onto the new ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
files() scene() physics(engineOption()) simulation()
local ground = get("/usr/scene/space"):new("HeightFieldCollider", "dunes")
ground.size = { 6, 6, 1 }
ground.columns = 2
ground.heights = { 1.5, 1.5, 1.5, 1.5 }
ground:new("ContactJointHandler", "surface").contactBounceMode = false
local crate = crateAt("crate", { 0.3, 0.2, 1.72 })
at(4, function()
  near("the height at rest", crate.position[3], 1.7, 0.02)
  ground.heights = { 0.5, 0.5, 0.5, 0.5 }
end)
at(6, function() near("the height of the crate", crate.position[3], 0.7, 0.02) end)
