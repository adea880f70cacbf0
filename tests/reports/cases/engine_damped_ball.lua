-- row: 4
-- input: a pellet of 5 g, 1e-7 kg m^2 about its centre, turns in a ball joint with a damping of 0.01 N m s/rad
-- right: it stands still, and so does the block that it hangs on
-- engines: all
-- args: --duration 0.6
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.005)
get("/usr/scene/world").gravity = { 0, 0, 0 }
local base = new("Transform", "/usr/scene/base")
local block = base:new("RigidBody", "block")
block:setBoxTotal(1, 0.1, 0.1, 0.1)
local _, pellet = lightLink(base, "link", 0.005, 0.01, 1e-7)
local ball = base:new("BallJoint", "ball")
ball:attach("../link/body", "../block")
ball:setAnchor(0, 0, 0)
ball:setDamping(0, 0.01)
pellet.angularVelocity = { 20, -10, 5 }
once(sim, 0.5, function()
  local spin = pellet.angularVelocity
  near("the pellet's spin about x", spin[1], 0, 0.02)
  near("the pellet's spin about y", spin[2], 0, 0.02)
  near("the distance to the block", pellet.position[1] - block.position[1], 0.01, 0.001)
end)
