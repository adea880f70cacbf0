-- row: 1
-- input: two crates rest on a shelf; the shelf is of no kind that they touch from 4 s on
-- right: they fall to the ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
shelfCase(function(shelf)
  local board = shelf:find("board")
  board.contactTypes = 0
  board.contactAffinities = 0
end)
