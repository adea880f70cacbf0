-- The surface of a contact combines the handlers of both sides, and a script gets an event for each touch.
-- expect: the bouncy ball rises to 1.0, the dead one stays at 0.2
-- expect: the slippery box slides on, the sticky one stops
-- expect: the ground hears touches of /usr/scene/
include "house.lua"
files() scene() physics() simulation()
local ground = new("PlaneCollider", "/usr/scene/ground")
local surface = ground:new("ContactJointHandler", "surface")
surface.contactBounceMode = false
surface.contactMu = 0
local function body(name, x, z, collider)
  local place = new("Transform", "/usr/scene/" .. name)
  place.localPos = { x, 0, z }
  if collider == "SphereCollider" then
    place:new("RigidBody", "body"):setSphereTotal(1, 0.2)
    place:new(collider, "collider").radius = 0.2
  else
    place:new("RigidBody", "body"):setBoxTotal(1, 0.4, 0.4, 0.4)
    place:new(collider, "collider").boxLengths = { 0.4, 0.4, 0.4 }
  end
  return place, place:find("collider"):new("ContactJointHandler", "surface")
end
local bouncy, b = body("bouncy", 0, 1.2, "SphereCollider")
b.contactBounceMode = true
b.contactBounceValue = 0.9
b.minBounceVel = 0.1
local dead, d = body("dead", 3, 1.2, "SphereCollider")
d.contactBounceMode = false
local slippery, s = body("slippery", 6, 0.2, "BoxCollider")
s.contactBounceMode = false
s.contactMu = 0
local sticky, t = body("sticky", 9, 0.2, "BoxCollider")
t.contactBounceMode = false
t.contactMu = 1000
for _, box in ipairs{ slippery, sticky } do box:find("body").velocity = { 0, 2, 0 } end
local touches = 0
ground:new("ScriptHandler", "bell"):on("collide", function(self, event)
  touches = touches + 1
  if touches == 1 then print("the ground hears touches of " .. event.data[1]) end
end)
local top, deadTop = 0, 0
on("rule", function(self, event)
  if event.cycle > 30 then
    top = math.max(top, bouncy.localPos[3])
    deadTop = math.max(deadTop, dead.localPos[3])
  end
  if event.cycle ~= 90 then return end
  print(string.format("the bouncy ball rises to %.1f, the dead one stays at %.1f", top, deadTop))
  if slippery.localPos[2] > 2.5 and sticky.localPos[2] < 0.2 then print("the slippery box slides on, the sticky one stops") end
end)
