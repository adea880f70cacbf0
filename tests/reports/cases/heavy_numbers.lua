-- row: 9
-- input: an MJCF file with limits that are upside down, directions of 0, a damping of 1e20, and numbers of `compiler`
--   and `option` that are none
-- right: each costs itself and is named; what has no limit then swings
-- engines: all
-- args: --duration 0.5
-- expect: heavy_numbers.xml:2:3: 'boundmass' of <compiler> is ignored: expected a number, found 'x'
-- expect: heavy_numbers.xml:2:3: 'inertiagrouprange' of <compiler> is ignored: expected 2 numbers, found '0'
-- expect: heavy_numbers.xml:3:3: 'iterations' of <option> is ignored: expected a whole number, found 1e+300
-- expect: heavy_numbers.xml:5:5: 'zaxis' of <body> is ignored: expected a direction that is not 0
-- expect: heavy_numbers.xml:6:7: <joint> 'loose', a damping of 1e+20 is taken as 1e+09
-- expect: heavy_numbers.xml:8:7: <site> 'nose' is left out: expected a direction that is not 0 for 'zaxis'
-- expect: heavy_numbers.xml:11:7: 'range' of <joint> is ignored: expected a lower and a higher number for 'range' of
--   <joint>, which is limited, found 20 10
-- expect: heavy_numbers.xml:11:7: 'actuatorfrcrange' of <joint> is ignored: expected a lower and a higher number
-- expect: heavy_numbers.xml:14:5: 'axisangle' of <body> is ignored: expected an axis that is not 0
-- expect: heavy_numbers.xml:15:7: 'range' of <joint> is ignored: expected a lower and a higher number
-- expect: heavy_numbers.xml:15:7: 'springdamper' of <joint> is ignored: expected two numbers above 0, found 1 0
-- expect: heavy_numbers.xml:23:5: 'xyaxes' of <frame> is ignored: expected two different directions
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("heavy_numbers.xml")
local function height(name) return get("/usr/scene/numbers/" .. name .. "/body").position[3] end
atTime(0.2, function()
  -- A point on a rod of 0.5 m that begins level: 9.81 / 0.5 rad/s^2.
  for _, name in ipairs { "arm", "door", "speck" } do
    near("the height of the " .. name, height(name), 5 - 0.5 * math.sin(0.5 * 9.81 / 0.5 * 0.2^2), 0.03)
  end
end)
get("/sys/server/scene/mjcf").strict = true
judge("strict refuses it", not pcall(function() get("/usr/scene"):importScene("heavy_numbers.xml", "strict-") end))
