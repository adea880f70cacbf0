-- row: 7
-- input: meshes of a hundredth of a millimetre, one that falls on a floor and one on which a box falls, and two flat
--   sheets on bodies
-- right: both specks collide; where the sheets do not, the log names the first
-- engines: all
-- args: --duration 0.9
include "../lib/judge.lua"
include "../lib/mesh.lua"
local space = meshWorld()
space:new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false

--- A cube with edges of two `s`; flattened to nothing along z where `flat`.
local function cube(at, name, s, flat)
  local mesh, points = at:new("TriMeshCollider", name), {}
  for x = -1, 1, 2 do
    for y = -1, 1, 2 do
      for z = -1, 1, 2 do
        points[#points + 1], points[#points + 2], points[#points + 3] = x * s, y * s, flat and 0 or z * s
      end
    end
  end
  mesh.vertices = points
  mesh.triangles = { 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3 }
  mesh:new("ContactJointHandler", "surface").contactBounceMode = false
  return mesh
end

--- A body of 1 kg.
local function bodyAt(name, x, z)
  local place = new("Transform", "/usr/scene/space/" .. name)
  place.localPos = { x, 0, z }
  local body = place:new("RigidBody", "body")
  body:setSphereTotal(1, 0.1)
  return place, body
end

local place, speck = bodyAt("speck", 0, 0.001)
cube(place, "mesh", 1e-5)
cube(space, "post", 1e-6):setLocalPosition(2, 0, 1)
local lid, box = bodyAt("lid", 2, 1.11)
local edge = lid:new("BoxCollider", "box")
edge:setBoxLengths(0.4, 0.4, 0.2)
edge:new("ContactJointHandler", "surface").contactBounceMode = false
for i = 1, 2 do cube(bodyAt("sheet" .. i, 4 + i, 5), "mesh", 0.1, true) end
atTime(0.8, function()
  near("the height of the speck", speck.position[3], 0, 0.002)
  near("the height of the lid", box.position[3], 1.1, 0.003)
end)
