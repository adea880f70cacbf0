-- row: 1
-- input: two crates rest on a shelf; gravity turns around at 4 s
-- right: they rise
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
local _, lower, upper = shelf()
at(4, function()
  near("the height at rest", lower.position[3], 2.25, 0.02)
  get("/usr/scene/world").gravity = { 0, 0, 9.81 }
end)
at(6, function() judge("the upper crate has risen to " .. upper.position[3], upper.position[3] > 15) end)
