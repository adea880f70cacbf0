-- row: 1
-- input: two crates rest on a shelf; gravity lets go of the upper one at 4 s, and a gust of 1 N lifts it for a moment
-- right: it rises
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
local _, _, upper = shelf()
at(4, function() upper.gravityOn = false; upper:addForce(0, 0, 1.0) end)
at(6, function() judge("the upper crate has risen to " .. upper.position[3], upper.position[3] > 2.67) end)
