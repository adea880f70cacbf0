-- row: 7
-- input: barrels that stand, lie, roll on and fall onto a yard of triangles, of one side and of two, with a wall
-- right: they stay where they are, or roll on straight; nothing is thrown
-- engines: all
-- args: --duration 3.2
include "../lib/judge.lua"
include "../lib/mesh.lua"
local space = meshWorld()
get("/sys/server/simulation").step = 0.01
-- A yard of 8 m by 3 m, and a wall of one side along its far end.
local up, down = { 0, 1, 2, 0, 2, 3 }, { 3, 2, 1, 3, 1, 0 }
local function yard(y, sides)
  local place = space:new("Transform", "yard" .. y)
  local mesh = place:new("TriMeshCollider", "ground")
  mesh.vertices = { -4, y - 1.5, 0, 4, y - 1.5, 0, 4, y + 1.5, 0, -4, y + 1.5, 0, 4, y - 1.5, 1, 4, y + 1.5, 1 }
  local all = {}
  for _, i in ipairs(up) do all[#all + 1] = i end
  for _, i in ipairs{ 1, 4, 5, 1, 5, 2 } do all[#all + 1] = i end
  if sides == 2 then for _, i in ipairs(down) do all[#all + 1] = i end end
  mesh.triangles = all
  mesh:new("ContactJointHandler", "surface").contactBounceMode = false
end
local function barrel(name, x, y, z, lies)
  local place = space:new("Transform", name)
  place.localPos = { x, y, z }
  if lies then place:setLocalRotation(90, 0, 0) end
  local body = place:new("RigidBody", "body")
  body:setCylinderTotal(3, 0.15, 0.4)
  local cylinder = place:new("CylinderCollider", "cylinder")
  cylinder.radius, cylinder.length = 0.15, 0.4
  cylinder:new("ContactJointHandler", "surface").contactBounceMode = false
  return body
end
local barrels = {}
for sides = 1, 2 do
  local y = 10 * sides
  yard(y, sides)
  local function add(what, x, z, lies)
    local rolls = what == "rolling"
    local body = barrel(what .. sides, x, y + (rolls and -0.7 or 0.3), z, lies)
    if rolls then body.velocity, body.angularVelocity = { 1.5, 0, 0 }, { 0, 10, 0 } end
    barrels[#barrels + 1] =
      { what = what .. ", " .. sides .. " sides", body = body, x = rolls and x + 1.5 * 3 or x, lies = lies,
        rolls = rolls }
  end
  add("standing", 1.2, 0.2)
  add("lying", -2.1, 0.1499, true)
  add("fallen", 2.3, 1.2)
  add("fallen and lying", -0.9, 1.15, true)
  add("rolling", -3.4, 0.1499, true)
end
local fast = 0
on("rule", function(_, event)
  for _, b in ipairs(barrels) do
    local v = b.body.velocity
    fast = math.max(fast, math.sqrt(v[1]^2 + v[2]^2 + v[3]^2))
  end
end)
atTime(3, function()
  for _, b in ipairs(barrels) do
    local p = b.body.position
    near("the place of the barrel that is " .. b.what, p[1], b.x, b.rolls and 0.7 or 0.01)
    near("its height", p[3], b.lies and 0.15 or 0.2, 0.006)
  end
  judge("the greatest speed was " .. fast, fast < 4.5)
end)
