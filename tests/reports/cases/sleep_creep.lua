-- row: 1
-- input: two crates rest on a shelf that sinks at 5 mm/s from 2 s on, more slowly than the speed of sleep
-- right: they sink with it
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
local place, lower, upper = shelf()
on("rule", function(_, event)
  if event.time > 1.999 and event.time < 5.999 then place.localPos = { 0.9, 0, 2 - 0.005 * (event.time - 2 + 0.02) } end
end)
at(6.4, function()
  near("the height of the lower crate", lower.position[3], 2.23, 0.003)
  near("the height of the upper crate", upper.position[3], 2.63, 0.004)
end)
