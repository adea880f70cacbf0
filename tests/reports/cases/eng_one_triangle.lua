-- row: 2
-- input: a hull, a box and a mesh lie on ramps that are meshes of one triangle each; two single triangles touch each other
-- right: the bodies stay on their ramps, and the host lives
-- engines: all
-- args: --duration 1.1
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
local space = "/usr/scene/space/"
local function surface(collider) collider:new("ContactJointHandler", "surface").contactBounceMode = false end
local function triangle(place, vertices)
  local mesh = place:new("TriMeshCollider", "triangle")
  mesh.vertices = vertices
  mesh.triangles = { 0, 1, 2 }
  surface(mesh)
end
local corners = {}
local sides = { 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5 }
for i = 0, 7 do
  for k = 0, 2 do corners[#corners + 1] = (i >> k) & 1 == 1 and 0.1 or -0.1 end
end
local bodies = {}
for i, shape in ipairs{ "ConvexCollider", "BoxCollider", "TriMeshCollider" } do
  local ramp = new("Transform", space .. "ramp" .. i)
  ramp.localPos = { 3 * i, 0, 0 }
  triangle(ramp, { -1, -1, 0, 1, -1, 0, 0, 1.5, 0 })
  local place = new("Transform", space .. "thing" .. i)
  place.localPos = { 3 * i, 0, 0.11 }
  bodies[i] = place:new("RigidBody", "body")
  bodies[i]:setBoxTotal(1, 0.2, 0.2, 0.2)
  local collider = place:new(shape, "shape")
  if shape == "BoxCollider" then collider.boxLengths = { 0.2, 0.2, 0.2 } else collider.vertices = corners end
  if shape == "TriMeshCollider" then collider.triangles = sides end
  surface(collider)
end
local fixed = new("Transform", space .. "fixed")
triangle(fixed, { -1, -1, 0, 1, -1, 0, 0, 1, 0 })
local free = new("Transform", space .. "free")
free.localPos = { 0, 0, 0.1 }
free:new("RigidBody", "body"):setBoxTotal(1, 0.2, 0.2, 0.2)
triangle(free, { 0, -0.2, -0.2, 0.1, 0.2, 0, -0.1, 0.2, 0.1 })
on("sense", function(_, event)
  if event.cycle ~= 50 then return end
  for i, body in ipairs(bodies) do near("the height of thing " .. i, body.position[3], 0.1, 0.006) end
end)
