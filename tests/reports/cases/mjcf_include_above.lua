-- row: 8
-- input: a model that includes a file of the folder above
-- right: it is found: the lamp stands on the floor of that file
-- engines: all
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mjcf_parts/lamp.xml")
atTime(1.8, function() near("the lamp's height", get("/usr/scene/lamp/lamp/body").position[3], 0.1, 0.005) end)
