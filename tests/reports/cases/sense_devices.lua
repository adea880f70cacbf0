-- row: 12
-- input: a Webots robot whose devices have ranges, noise and resolutions
-- right: each has them; nothing is named, as all of it acts
-- args: --duration 1
-- never: is not supported
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics() simulation() agents{ port = 0 }
plugin "sensors" plugin "effectors"
get("/sys/server/scene/webots").strict = true
local robot = new("AgentAspect", "/usr/scene/space/robot")
robot:importScene("sense_devices.wbt", "p-")
local made = {}
local function list(node)
  for _, c in ipairs(node:children()) do
    made[c.name] = made[c.name] or c
    list(c)
  end
end
list(robot)
near("nearest depth", made.depth.zNear, 0.4, 1e-9)
near("farthest depth", made.depth.zFar, 6, 1e-9)
near("noise of a depth [mm]", made.depth:children()[1].sigma, 6, 1e-9)
near("resolution of a depth [mm]", made.depth:children()[2].step, 10, 1e-9)
near("nearest colour", made.colour.zNear, 0.2, 1e-9)
near("farthest colour", made.colour.zFar, 9, 1e-9)
near("noise of a lidar", made.scan:children()[1].sigma, 0.07, 1e-9)
near("resolution of a lidar", made.scan:children()[2].step, 0.05, 1e-9)
near("range of a short sensor", made.short.maxRange, 0.8, 1e-9)
near("its resolution", made.short:children()[1].step, 0.1, 1e-9)
near("accuracy of a position", made.where:children()[1].sigma, 0.2, 1e-9)
near("range of a gyroscope [deg/s]", made.upside:children()[1].most, 57.2957795, 1e-4)
near("resolution of an accelerometer", made.felt:children()[1].step, 0.5, 1e-9)
