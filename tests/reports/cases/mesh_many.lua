-- row: 7
-- input: a hundred chairs with the same 1,500 corners
-- right: their hull is made once, and all fall
-- engines: all
-- args: --duration 0.2
-- expect: right: 2 meshes
include "../lib/judge.lua"
include "../lib/mesh.lua"
local space = meshWorld()
local corners = {}
for i = 1, 1500 do
  local z, turn = 1 - (2 * i - 1) / 1500, 2.39996323 * i
  local r = math.sqrt(1 - z * z)
  for _, v in ipairs{ 0.2 * r * math.cos(turn), 0.2 * r * math.sin(turn), 0.4 * z } do corners[#corners + 1] = v end
end
local last
for i = 1, 100 do
  local place = space:new("Transform", "chair" .. i)
  place.localPos = { 2 * (i % 40), 2 * (i // 40), 1 }
  last = place:new("RigidBody", "body")
  last:setBoxTotal(5, 0.4, 0.4, 0.8)
  local hull = place:new("ConvexCollider", "hull")
  hull.vertices = corners
  hull:new("ContactJointHandler", "surface").contactBounceMode = false
end
local meshes = get("/usr/scene/world").meshes
judge(meshes .. " meshes: the points and their hull", meshes == 2)
atTime(0.18, function() judge("the last one falls, to " .. last.position[3], last.position[3] < 0.95) end)
