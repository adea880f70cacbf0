-- row: 8
-- input: a rotation of 0, fractions where whole numbers belong, moments that no body can have; once with `strict`
-- right: the model loads and its arm swings; what is made of each value is named; with `strict` it is refused
-- engines: all
-- args: --duration 0.5
-- expect: mjcf_odd_values.xml:3:3: 'iterations' of <option> is taken without its fraction: expected a whole number
-- expect: mjcf_odd_values.xml:5:5: a 'quat' of 0 in <body> is taken as no rotation
-- expect: mjcf_odd_values.xml:5:5: the <inertial> of a <body> with moments of inertia that no body can have gets
--   their mean
-- expect: mjcf_odd_values.xml:8:7: 'group' of <geom> is taken without its fraction
-- expect: mjcf_odd_values.xml:11:7: a ball <joint> that is limited to 0 has no limit
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mjcf_odd_values.xml")
local arm = get "/usr/scene/odd/turned/body"
local I = 0.9 + 0.1 + 0.1
-- A pendulum of 0.5 m that begins level: its first fall is that of a constant torque.
local turn = 0.5 * (9.81 * 0.5 / (0.25 + I / 3)) * 0.1^2
atTime(0.1, function() near("fall of the arm", 1 - arm.position[3], 0.5 * math.sin(turn), 0.006) end)
get("/sys/server/scene/mjcf").strict = true
judge("strict refuses it", not pcall(function() get("/usr/scene"):importScene("mjcf_odd_values.xml") end))
