-- row: 7
-- input: two flat sheets as meshes of bodies, with MuJoCo
-- right: they do not collide, and the log names the first collider
-- engines: MujocoEngine
-- args: --duration 0.1
-- expect: /usr/scene/space/sheet1/mesh (and 1 more): a mesh of 2 triangles is flat
include "../lib/mesh.lua"
local space = meshWorld()
for i = 1, 2 do
  local place = space:new("Transform", "sheet" .. i)
  place:new("RigidBody", "body"):setSphereTotal(1, 0.1)
  local mesh = place:new("TriMeshCollider", "mesh")
  mesh.vertices = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 }
  mesh.triangles = { 0, 1, 2, 0, 2, 3 }
end
