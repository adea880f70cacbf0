-- A handler with an endless loop uses its budget once, is then disabled, and the simulation continues.
-- expect: stopped after 50000000 instructions: is there an endless loop?
-- expect: It is switched off: it would take as long every time.
-- expect: it ran 1 time
-- expect: "cycles":100,
include "house.lua"
files() scene() physics() simulation()
local times = 0
on("act", function()
  times = times + 1
  while true do end
end)
on("rule", function(self, event)
  if event.cycle == 99 then print("it ran " .. times .. " time" .. (times > 1 and "s" or "")) end
end)
