-- row: 7
-- input: bodies that move, of a mesh file with a tetrahedron and one line far away, in MJCF, URDF and Webots
-- right: the log says that the line does not collide, and a ray through its place meets nothing
-- engines: all
-- args: --duration 0.1
-- expect: the mesh 'last_mesh_lines.obj' has 1 line, which do not collide
include "../lib/judge.lua"
include "../lib/mesh.lua"
local space = meshWorld()
for i, kind in ipairs{ "xml", "urdf", "wbt" } do
  local place = new("Transform", "/usr/scene/space/" .. kind)
  place.localPos = { 100 * i, 0, 0 }
  place:importScene("last_mesh_lines." .. kind)
end
atTime(0.02, function()
  local physics = get("/sys/server/physics")
  for i, kind in ipairs{ "xml", "urdf", "wbt" } do
    judge(kind .. ": the tetrahedron collides", physics:castRay({ 100 * i, 0, 20 }, { 0, 0, -1 }, 40))
    judge(kind .. ": the line does not", not physics:castRay({ 100 * i + 3, 3, 20 }, { 0, 0, -1 }, 40))
  end
end)
