-- A contact handler may remove a body after the step, and the other bodies are unaffected.
-- expect: eaten
-- expect: a fell 0.47 m, b 0.47, c 0.47
include "house.lua"
files() scene() physics(engineOption()) simulation()
local function ball(name, y, z)
  local place = new("Transform", "/usr/scene/" .. name)
  place.localPos = { 0, y, z }
  place:new("RigidBody", "body"):setSphereTotal(1, 0.2)
  place:new("SphereCollider", "collider").radius = 0.2
  return place
end
new("PlaneCollider", "/usr/scene/ground")
ball("first", 0, 0.25)
local a, b, c = ball("a", 5, 50), ball("b", 10, 100), ball("c", 15, 150)
get("/usr/scene/first/collider"):new("ScriptHandler", "bell"):on("collide", function()
  if get("/usr/scene/first") then print("eaten") delete("/usr/scene/first") end
end)
on("publish", function(self, event)
  if event.cycle ~= 15 then return end
  assert(a.localPos[2] == 5 and b.localPos[2] == 10 and c.localPos[2] == 15)
  print(string.format("a fell %.2f m, b %.2f, c %.2f", 50 - a.localPos[3], 100 - b.localPos[3], 150 - c.localPos[3]))
end)
