-- The physics server of a world can be replaced, but not by a contact handler in the middle of a step.
-- expect: the server went: true
-- expect: from a touch: cannot remove /sys/server/physics now: it is in use: a step is under way
-- expect: the ball lies at 0.2
include "house.lua"
files() scene() physics() simulation()
local ground = new("PlaneCollider", "/usr/scene/ground")
local place = new("Transform", "/usr/scene/ball")
place.localPos = { 0, 0, 1 }
place:new("RigidBody", "body"):setSphereTotal(1, 0.2)
local collider = place:new("SphereCollider", "collider")
collider.radius = 0.2
for _, c in ipairs{ ground, collider } do
  local solid = c:new("ContactJointHandler", "solid")
  solid.contactBounceMode = false
end
local touches = 0
ground:new("ScriptHandler", "bell"):on("collide", function()
  touches = touches + 1
  if touches ~= 1 then return end
  delete("/usr/scene/nothing") -- the first error ends the handler only
end)
ground:new("ScriptHandler", "second"):on("collide", function()
  if touches == 3 then print("from a touch:", select(2, pcall(delete, "/sys/server/physics"))) end
end)
on("act", function(self, event)
  if event.cycle == 20 then
    print("the server went:", (pcall(delete, "/sys/server/physics")))
    new("PhysicsServer", "/sys/server/physics")
    new("OdeCollision", "/sys/server/physics/collision")
    new("OdeEngine", "/sys/server/physics/engine")
  end
  if event.cycle == 99 then print(string.format("the ball lies at %.1f", place.localPos[3])) end
end)
