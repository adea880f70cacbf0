-- Patterns of exponential cost and large texts and tables use up the budget of a handler like a loop.
-- expect: patterns_without_end.lua:8: stopped after 50000000 instructions
-- expect: patterns_without_end.lua:9: stopped after 50000000 instructions
-- expect: patterns_without_end.lua:10: stopped after 50000000 instructions
-- expect: "cycles":100,
include "house.lua" files() scene() simulation()
local long = ("a"):rep(1000000)
on("act", function() string.find(long, ".-.-.-b") end)
on("prepare", function() long:match("(a*)*(a*)(a*)(a*)b") end)
on("rule", function() while true do long = long .. long end end)
