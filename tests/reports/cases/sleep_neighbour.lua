-- row: 1
-- input: two crates rest on each other; a script moves the lower one away at 4 s
-- right: the upper one falls onto the shelf
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
shelfCase(function(_, lower) lower.position = { 1.5, 0, 2.25 } end, 2.25, 2.25)
