-- row: 1
-- input: two crates rest on each other; the lower one is deleted at 4 s
-- right: the upper one falls onto the shelf
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
local _, lower, upper = shelf()
at(4, function() get("/usr/scene/space/lower"):delete() end)
at(6, function() near("the height of the upper crate", upper.position[3], 2.25, 0.02) end)
