-- row: 8
-- input: an MJCF file with a timestep, a density, a viscosity and margins below 0, which MuJoCo takes
-- right: the ball comes to rest on the floor; what is made of each number is named
-- engines: all
-- args: --duration 1.1
-- expect: 'timestep' of <option> is ignored: expected 1e-06 or more, found -0.01
-- expect: 'density' of <option> is taken as 0
-- expect: 'viscosity' of <option> is taken as 0
-- expect: 'tolerance' of <option> is taken as 0
-- expect: 'impratio' of <option> is ignored
-- expect: 'iterations' of <option> is taken as 10000
-- expect: 'solmix' of <geom> is taken as 0
-- never: left out
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
get("/usr/scene"):importScene("eng_odd_numbers.xml")
local ball
on("sense", function(_, event)
  ball = ball or get "/usr/scene/odd/ball/body"
  if event.cycle == 50 then near("the height of the ball", ball.position[3], 0.1, 0.005) end
end)
