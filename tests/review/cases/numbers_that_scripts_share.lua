-- A group of variables is shared by all scripts and is part of the tree.
-- expect: the config sees 10
-- expect: Sumo.bouts is 10 at /sys/variables/Sumo
include "house.lua"
files() scene() simulation()
new("Variables", "/sys/variables/Sumo"):set("bouts", 0)
new("Transform", "/usr/scene/ring"):attachScript("scripts/bouts.lua")
on("rule", function(self, event)
  if event.cycle ~= 20 then return end
  print("the config sees " .. Sumo.bouts)
  local group = get("/sys/variables/Sumo")
  print("Sumo.bouts is " .. group.bouts .. " at " .. tostring(group))
end)
