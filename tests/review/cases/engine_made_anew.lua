-- World and engine can be removed and created again, which starts a new world.
-- expect: the new ball fell to 44
include "house.lua"
files() scene() physics() simulation()
local function ball()
  local place = new("Transform", "/usr/scene/ball")
  place.localPos = { 0, 0, 50 }
  place:new("RigidBody", "body"):setSphereTotal(1, 0.2)
  place:new("SphereCollider", "collider").radius = 0.2
  return place
end
local old = ball()
on("act", function(self, event)
  if event.cycle == 40 then
    old:delete()
    delete("/usr/scene/space") delete("/usr/scene/world") delete("/sys/server/physics/engine")
    new("OdeEngine", "/sys/server/physics/engine") new("World", "/usr/scene/world") new("Space", "/usr/scene/space")
    old = ball()
  end
  if event.cycle == 95 then print(string.format("the new ball fell to %.0f", old.localPos[3])) end
end)
