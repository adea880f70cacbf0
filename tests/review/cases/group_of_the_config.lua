-- A node imported into a group that the config created moves with the group.
-- expect: the room has 2 children
-- expect: the chair is at 11
include "house.lua"
files() scene() physics() simulation()
local room = new("Transform", "/usr/scene/room")
room:importScene("rsg/review/room.rsg")
print("the room has " .. #room:children() .. " children")
on("act", function(self, event)
  if event.cycle == 2 then room:setLocalPos(10, 0, 0) end
end)
on("rule", function(self, event)
  if event.cycle == 3 then print(string.format("the chair is at %.0f", get("/usr/scene/room/chair").worldTransform[13])) end
end)
