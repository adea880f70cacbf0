-- row: pF13
-- input: a scene file attaches a script to a transform, with an argument, and one that is not there
-- right: the script runs in each cycle; a missing one is an error of the import
-- args: --duration 0.4
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation()
get("/usr/scene"):importScene("rsg/agent/papers_parts/scripted.rsg")
local good, why = pcall(function() get("/usr/scene"):importScene("rsg/agent/papers_parts/unscripted.rsg") end)
judge("a missing script is an error: " .. tostring(why):sub(1, 80), not good and why:find("nowhere.lua", 1, true))
on("rule", function(self, event)
  if event.cycle == 10 then near("way", get("/usr/scene/counter").localPos[1], 30, 3) end
end)
