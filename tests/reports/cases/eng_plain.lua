-- row: 12
-- input: an MJCF file that asks for nothing that MuJoCo alone does, also with `strict`
-- right: nothing is said to have no effect
-- engines: all
-- args: --duration 0.1
-- never: no effect
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
get("/sys/server/scene/mjcf").strict = true
judge("strict takes it", (pcall(function() get("/usr/scene"):importScene("eng_plain.xml") end)))
