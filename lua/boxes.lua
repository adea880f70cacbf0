-- 54 crates, marbles and pills fall into a walled yard: the smallest simulation with physics.
--
--     sparkhost --config boxes.lua --rate max --duration 10
include "house.lua"
include "materials.lua"

local sceneFile = option{ name = "scene", default = "rsg/boxspheres/yard.rsg", doc = "The scene file to drop." }
local half = option{ name = "half", default = 6.0, doc = "Half the yard's edge, in metres." }

files()
scene()
materials()
physics(engineOption())
simulation()
web()

get("/usr/scene"):importScene(sceneFile, half)
