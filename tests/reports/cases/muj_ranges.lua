-- row: 8
-- input: models of three languages with masses, places, damping and gains that no engine computes with
-- right: each is brought into its range and named, and all else moves; with `strict` the model is refused
-- engines: all
-- args: --duration 0.9
-- expect: <body> 'heavy', a mass of 1e+16 is taken as 1e+15
-- expect: 'pos' of <body> is ignored: expected a place at most 1e+06 m away
-- expect: <joint> 'hinge', a damping of 1e+308 is taken as 1e+12
-- expect: 'armature' of <joint> is ignored: expected a number, found 'nan'
-- expect: 'stiffness' of <joint> is ignored: expected a number, found 'x'
-- expect: <position> 'drive', a gain of 1e+300 is taken as 1e+12
-- expect: <link> 'heavy', a mass of 1e+300 is taken as 1e+15
-- expect: <joint> 'lift', a limit of -1e+300 is taken as -1e+06
-- expect: expected a place at most 1e+06 m away; 0 0 0 is taken
-- never: no number
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("muj_ranges.xml")
local urdf, webots = new("Transform", "/usr/scene/urdf"), new("Transform", "/usr/scene/webots")
urdf.localPos, webots.localPos = { 0, 10, 0 }, { 0, 20, 0 }
urdf:importScene("muj_ranges.urdf", "", "fixed")
webots:importScene("muj_ranges.wbt", "", "fixed")
local ball, swing = get "/usr/scene/ranges/ball/body", get "/usr/scene/urdf/ranges/arm/body"
atTime(0.2, function() near("the height of the arm", swing.position[3], 1 - 0.13, 0.05) end)
-- MuJoCo's solver stops at a tolerance that is relative to the mean inertia of the world.
local solvesBall = get("/sys/server/physics/engine").class ~= "MujocoEngine"
atTime(0.8, function()
  local z = ball.position[3]
  if solvesBall then near("the height of the ball", z, 0.1, 0.005) else judge("the ball has a height", z == z) end
end)
for language, file in pairs { mjcf = "xml", urdf = "urdf", webots = "wbt" } do
  get("/sys/server/scene/" .. language).strict = true
  local refused = not pcall(function() get("/usr/scene"):importScene("muj_ranges." .. file, "strict-") end)
  judge("strict refuses the " .. file, refused)
end
