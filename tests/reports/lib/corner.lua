-- A robot that does not move, with a rangefinder and an IMU whose y axis points up, and a wall of the same file.
include "judge.lua"
include "senses.lua"

--- Imports the file with its arguments, and judges the percepts. `names`: of accelerometer, gyroscope and rangefinder.
function judgeCorner(names, ...)
  files() scene() physics(engineOption()) simulation() agents{ port = 0 }
  plugin "sensors" plugin "effectors"
  local robot = new("AgentAspect", "/usr/scene/space/robot")
  robot:importScene(...)
  watch(robot, function(seen, time)
    if not isAt(time, 0.1) then return end
    local a, w, d = seen[names[1]], seen[names[2]], seen[names[3]]
    judge("all are there", a and w and d)
    for i = 1, 3 do
      near("acceleration " .. i, a[3][i + 1], i == 2 and 9.81 or 0, 1e-3)
      near("rate " .. i, w[3][i + 1], 0, 1e-9)
    end
    near("distance", d[3][2], 2.5, 0.011)
  end)
end
