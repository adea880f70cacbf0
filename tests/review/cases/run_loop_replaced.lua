-- The run loop cannot be removed while it runs, and stop() ends it.
-- expect: cannot remove /sys/server/simulation now: it is in use: the run loop is at work; stop() ends it after the current cycle
-- expect: cannot remove /sys/server now: /sys/server/simulation is in use
-- expect: "cycles":60,
include "house.lua"
files() scene() physics() simulation()
on("act", function(self, event)
  if event.cycle == 50 then
    print(select(2, pcall(delete, "/sys/server/simulation")))
    print(select(2, pcall(delete, "/sys/server")))
    print(select(2, pcall(function() get("/sys"):unlinkChildren() end)))
  end
  if event.cycle == 60 then get("/sys/server/simulation"):stop() end
end)
