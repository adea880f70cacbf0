-- row: 8
-- input: a flat sheet, and a speck of a micrometre, as meshes of a robot that falls, and of a fixed one
-- right: on what moves the sheet is left out and named; where it is fixed its triangles carry a ball
-- engines: all
-- args: --duration 1
-- expect: a <collision> is left out: a flat mesh has no convex hull
-- expect: no convex hull: expected vertices that span
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mesh_sheet.urdf", "", "fixed")
local place = new("Transform", "/usr/scene/place")
place.localPos = { 5, 0, 10 }
place:importScene("mesh_sheet.urdf", "b-", "free")
local falling = get("/usr/scene/place/b-sheet/b-plate/body")
local body = ball("ball", 0.1, 0.3, 0.2, 0.12)
atTime(0.9, function()
  near("height of the ball on the sheet", body.position[3], 0.1, 0.004)
  near("height of the sheet that falls", falling.position[3], 10 - 9.81 * 0.9^2 / 2, 0.15)
end)
