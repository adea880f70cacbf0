-- row: 1
-- input: two crates rest on a shelf that rises at 0.3 m/s from 4 s on
-- right: they rise with it
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
local place, lower, upper = shelf()
on("rule", function(_, event)
  if event.time > 3.999 and event.time < 5.999 then place.localPos = { 0.9, 0, 2 + 0.3 * (event.time - 4 + 0.02) } end
end)
at(6.4, function()
  near("the height of the lower crate", lower.position[3], 2.85, 0.03)
  near("the height of the upper crate", upper.position[3], 3.25, 0.03)
end)
