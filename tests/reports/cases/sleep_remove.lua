-- row: 1
-- input: two crates rest on a shelf; the shelf is removed at 4 s
-- right: they fall to the ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
shelfCase(function(shelf) shelf:delete() end)
