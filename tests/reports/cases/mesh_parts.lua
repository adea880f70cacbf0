-- row: 6
-- input: a Collada file in decimetres: a block of quads, one of triangles in nested nodes, a mirrored one, and a line
-- right: a ball lies on each of the three blocks; the line is named
-- engines: all
-- args: --duration 2
-- expect: has 1 line
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mesh_two_blocks.urdf")
-- The low block is 0.2 m high, and 0.4 m wide; the others stand on it and are 0.1 m high.
local low = ball("low", 0.03, 0, 0, 0.24)
local right, left = ball("right", 0.03, 0.1, 0, 0.34), ball("left", 0.03, -0.1, 0, 0.34)
atTime(1.9, function()
  near("height of the ball on the quads", low.position[3], 0.23, 0.003)
  near("height of the ball on the triangles", right.position[3], 0.33, 0.003)
  near("height of the ball on the mirrored block", left.position[3], 0.33, 0.003)
end)
