-- The engine of a world can be replaced, and all bodies continue from their state.
-- expect: the engine went: true a new one came: true
-- expect: a new body: true
-- expect: both fall
include "house.lua"
files() scene() physics() simulation()
local function ball(name, y)
  local place = new("Transform", "/usr/scene/" .. name)
  place.localPos = { 0, y, 50 }
  place:new("RigidBody", "body"):setSphereTotal(1, 0.2)
  place:new("SphereCollider", "collider").radius = 0.2
  return place
end
local first, second = ball("first", 0), nil
on("act", function(self, event)
  if event.cycle == 40 then
    print("the engine went:", (pcall(delete, "/sys/server/physics/engine")),
          "a new one came:", (pcall(new, "OdeEngine", "/sys/server/physics/engine")))
  end
  if event.cycle == 60 then
    print("a new body:", pcall(function() second = ball("second", 5) end))
  end
  if event.cycle == 90 and first.localPos[3] < 40 and second.localPos[3] < 49 then print("both fall") end
end)
