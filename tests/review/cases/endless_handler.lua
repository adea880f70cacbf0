-- A handler without end costs its budget once: it is switched off, and the house goes on.
-- expect: stopped after 50000000 instructions: is there an endless loop?
-- expect: It is switched off: it would take as long every time.
-- expect: "cycles":100,
include "house.lua"
files() scene() physics() simulation()
on("act", function() while true do end end)
