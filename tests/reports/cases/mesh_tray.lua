-- row: 7
-- input: a fixed tray, one closed mesh with a hollow, into which a ball falls
-- right: the ball lies on the bottom of the tray, 0.1 m above its lower side
-- engines: all
-- args: --duration 2
-- never: collides as its convex hull
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mesh_tray.urdf")
local body = ball("ball", 0.05, 0.02, 0.1, 0.9)
atTime(1.9, function()
  near("height of the ball", body.position[3], 0.65, 0.004)
  near("x of the ball", body.position[1], 0.02, 0.02)
end)
