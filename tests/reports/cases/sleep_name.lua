-- row: 1
-- input: two crates rest on a shelf; the shelf excludes their boxes by name at 4 s
-- right: both fall to the ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
shelfCase(function(shelf) shelf:find("board"):addNotCollideWithColliderName("box", true) end)
