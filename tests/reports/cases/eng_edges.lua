-- row: 7
-- input: cylinders at the edge of a bench of triangles: one lies beside it, one rolls off, a pole leans over it
-- right: what has its middle beside the edge falls, what rolls off falls, the pole comes down on the bench
-- engines: all
-- args: --duration 2
include "../lib/judge.lua"
include "../lib/mesh.lua"
local space = meshWorld()
get("/sys/server/simulation").step = 0.01
-- A bench from x = 0 to 1 and of 1 m in height.
local function bench(y)
  local mesh = space:new("TriMeshCollider", "bench" .. y)
  local low, high = y - 0.6, y + 0.6
  mesh.vertices = { 0, low, 0, 1, low, 0, 1, high, 0, 0, high, 0, 0, low, 1, 1, low, 1, 1, high, 1, 0, high, 1 }
  mesh.triangles = { 0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4,
                     3, 4, 7 }
  mesh:new("ContactJointHandler", "surface").contactBounceMode = false
end
local function cylinder(name, radius, length, at, turns)
  bench(at[2])
  local place = space:new("Transform", name)
  place.localPos = at
  place:setLocalRotation(table.unpack(turns))
  local body = place:new("RigidBody", "body")
  body:setCylinderTotal(3, radius, length)
  local shape = place:new("CylinderCollider", "shape")
  shape.radius, shape.length = radius, length
  shape:new("ContactJointHandler", "surface").contactBounceMode = false
  return body
end
local beside = cylinder("beside", 0.15, 0.4, { -0.1, 0, 1 + math.sqrt(0.1499^2 - 0.1^2) }, { 90, 0, 0 })
local rolling = cylinder("rolling", 0.15, 0.4, { 0.3, 4, 1.1499 }, { 90, 0, 0 })
rolling.velocity, rolling.angularVelocity = { -0.7, 0, 0 }, { 0, -0.7 / 0.15, 0 }
-- Its middle is 0.3 m up from the edge, above the bench.
local angle, up = math.rad(50), 0.3
local pole = cylinder("pole", 0.05, 2, { up * math.cos(angle) - 0.0499 * math.sin(angle), 8,
                                         1 + 0.0499 * math.cos(angle) + up * math.sin(angle) }, { 0, 40, 0 })
atTime(1.5, function()
  judge("the barrel beside the edge has fallen", beside.position[3] < 0.7)
  judge("the barrel that rolls has left the bench", rolling.position[1] < 0 and rolling.position[3] < 1)
  near("the height of the pole", pole.position[3], 1.05, 0.01)
  near("its speed", math.abs(pole.velocity[1]) + math.abs(pole.velocity[3]), 0, 0.05)
end)
