-- A yard with boxes, spheres and capsules, and pictures of it: agents that say (scene rsg/agent/camera.rsg) get a
-- camera.
--
--     sparkhost --config camera.lua
--
-- plugins/camera/README.md has a client that saves a picture.
include "house.lua"
include "materials.lua"

local half = option{ name = "half", default = 6.0, doc = "Half the yard's edge, in metres." }

files()
scene()
materials()
camera()
physics(engineOption())
simulation()
agents{}
web()
control()
plugin "sensors"
plugin "effectors"

get("/usr/scene"):importScene("rsg/boxspheres/yard.rsg", half)
