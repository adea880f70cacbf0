-- row: 2
-- input: MuJoCo's compiler takes no mesh of three corners
-- right: the log names the collider, and the host lives
-- engines: MujocoEngine
-- args: --duration 0.5
-- expect: MuJoCo does not take this world
-- expect: /usr/scene/flake/hull: MuJoCo:
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
include "../lib/crate.lua"
local _, stone = crate("stone", 0, 5)
local _, flake = crate("flake", 2, 5)
stone:new("BoxCollider", "box"):setBoxLengths(0.4, 0.4, 0.4)
local hull = flake:new("ConvexCollider", "hull")
hull.vertices = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 }
hull:new("MujocoMesh", "mujoco").vertices = { 0, 0, 0, 1, 0, 0, 0, 1, 0 }
on("sense", function(_, event)
  if event.cycle == 20 then near("the height of the stone, in a world that stands still", stone.position[3], 5, 0) end
end)
