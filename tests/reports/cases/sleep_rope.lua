-- row: 1
-- input: a lamp hangs on a joint, at rest; the joint is deleted at 4 s
-- right: the lamp falls to the ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
files() scene() physics(engineOption()) simulation()
flatGround()
local lamp = crateAt("lamp", { 0, 0, 2 })
local rope = get("/usr/scene/space/lamp"):new("BallJoint", "rope")
rope:attach("../body")
rope:setAnchor(0, 0, 1)
at(4, function()
  near("the height at rest", lamp.position[3], 2, 0.02)
  rope:delete()
end)
at(6, function() near("the height of the lamp", lamp.position[3], 0.2, 0.02) end)
