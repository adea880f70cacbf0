-- row: 11
-- input: a robot with a rangefinder and an IMU that does not move, and a wall of the same file, of mjcf
-- right: it sees the wall at 2.5 m, not its own shapes; the IMU senses gravity along its y axis, and no rates
-- engines: all
-- args: --duration 0.2
-- never: is not supported
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics(engineOption()) simulation() agents{ port = 0 }
plugin "sensors" plugin "effectors"
local robot = new("AgentAspect", "/usr/scene/space/robot")
robot:importScene("webots_corner.xml")
watch(robot, function(seen, time)
  if not isAt(time, 0.1) then return end
  local a, w, d = seen["ACC rolled"], seen["GYR still"], seen["DST ahead"]
  judge("all are there", a and w and d)
  for i = 1, 3 do
    near("acceleration " .. i, a[3][i + 1], i == 2 and 9.81 or 0, 1e-3)
    near("rate " .. i, w[3][i + 1], 0, 1e-9)
  end
  near("distance", d[3][2], 2.5, 0.011)
end)
