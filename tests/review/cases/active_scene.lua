-- Changing the active scene takes effect in the same cycle.
-- expect: after 50 cycles: here 50.00, there 45.00
-- expect: after 100 cycles: here 45.00, there 45.00
include "house.lua"
files() scene() physics() simulation()
get("/sys/server/scene"):createScene("/usr/other")
new("World", "/usr/other/world") new("Space", "/usr/other/space")
local function ball(scene)
  local place = new("Transform", scene .. "/ball")
  place.localPos = { 0, 0, 50 }
  place:new("RigidBody", "body"):setSphereTotal(1, 0.2)
  return place
end
local here, there = ball("/usr/scene"), ball("/usr/other")
on("act", function(self, event)
  if event.cycle == 51 then get("/sys/server/scene").activeScene = "/usr/scene" end
end)
on("publish", function(self, event)
  if event.cycle % 50 == 0 then
    print(string.format("after %d cycles: here %.2f, there %.2f", event.cycle, here.localPos[3], there.localPos[3]))
  end
end)
