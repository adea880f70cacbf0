-- row: 1
-- input: two crates rest on a shelf; a handler that only listens replaces the surface of the shelf at 4 s
-- right: they fall to the ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
shelfCase(function(shelf)
  shelf:find("board/surface"):delete()
  shelf:find("board"):new("RecorderHandler", "bell")
end)
