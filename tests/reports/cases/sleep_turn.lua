-- row: 1
-- input: two crates rest on a shelf; the shelf turns by 90 degrees at 4 s
-- right: they fall to the ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
shelfCase(function(shelf) shelf:find("board"):setRotation(0.0, 0.0, 0.0, 0.0, 90.0, 0.0) end)
