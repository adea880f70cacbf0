-- row: 1
-- input: two crates rest on a shelf; gravity turns around at 4 s
-- right: they rise
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
shelfCase("gravity")
