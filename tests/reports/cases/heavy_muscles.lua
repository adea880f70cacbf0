-- row: 8
-- input: muscles and a pair with numbers of which MuJoCo makes no world
-- right: each is left out and named, the arm swings
-- engines: all
-- args: --duration 0.5
-- expect: heavy_muscles.xml:12:12: <pair> is left out: expected 1, 3, 4 or 6 for 'condim', found 2
-- expect: heavy_muscles.xml:14:5: <muscle> 'free' is left out: expected a 'lengthrange' of the muscle, or a limit
-- expect: heavy_muscles.xml:15:5: <muscle> 'scaled' is left out: expected a lower and a higher number for the range
-- expect: heavy_muscles.xml:16:5: <muscle> 'turned' is left out: expected a lower and a higher number for the range
-- never: MuJoCo does not take this world
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("heavy_muscles.xml")
local arm = get "/usr/scene/muscles/arm/body"
atTime(0.2, function()
  near("the height of the arm", arm.position[3], 5 - 0.5 * math.sin(0.5 * 9.81 / 0.5 * 0.2^2), 0.03)
end)
