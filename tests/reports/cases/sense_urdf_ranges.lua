-- row: 12
-- input: a URDF robot with a scanner of three rays to the right and ahead, noise, a slow rate, an imu with noise, a
--   camera
-- right: ranges, resolution, noise, rate and picture as the file says
-- args: --duration 1
-- never: is not supported
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics() simulation() agents{ port = 0 }
plugin "sensors" plugin "effectors"
get("/sys/server/scene/urdf").strict = true
local robot = new("AgentAspect", "/usr/scene/space/robot")
get("/usr/scene/world").gravity = { 0, 0, 0 }
robot:importScene("sense_eyes.urdf")
local wall = new("Transform", "/usr/scene/space/wall")
wall.localPos = { 2.24, 0, 0 }
wall:new("BoxCollider", "box").boxLengths = { 0.2, 1, 2 }
local scans, noisy, turned, pushed, last = 0, {}, nil, {}, nil
watch(robot, function(seen, time)
  if seen["LDR scan"] then scans, last = scans + 1, seen["LDR scan"][3] end
  if seen["LDR noisy"] then table.insert(noisy, seen["LDR noisy"][3]) end
  turned = seen["GYR shaky_gyro"] and seen["GYR shaky_gyro"][3] or turned
  if seen["ACC shaky_acc"] then table.insert(pushed, seen["ACC shaky_acc"][3]) end
  if not isAt(time, 0.9) then return end
  near("the mean of a noise of a gyroscope [deg/s]", turned[4], math.deg(0.5), 0.01)
  near("its other axes", math.abs(turned[2]) + math.abs(turned[3]), 0, 0.01)
  local x, y = 0, 0
  for _, a in ipairs(pushed) do x, y = x + a[2]^2, y + a[3]^2 end
  near("the noise of an accelerometer", math.sqrt(x / #pushed), 2, 1)
  near("its other axis", math.sqrt(y / #pushed), 0, 0.01)
  judge("the slow scanner has sensed 9 or 10 times: " .. scans, scans >= 8 and scans <= 10)
  near("right", last[2], 3.5, 1e-6)
  near("half right", last[3], 3.5, 1e-6)
  near("ahead, in steps of 0.25 m", last[4], 2, 1e-6)
  local low, high, silent = 9, 0, 0
  for _, d in ipairs(noisy) do
    low, high = math.min(low, d[2]), math.max(high, d[2])
    if d[3] == 3.5 then silent = silent + 1 end
  end
  judge("the noise has a width: " .. high - low, high - low > 0.3 and high <= 3.5)
  judge("no echo stays 3.5 m", silent == #noisy)
end)
local eye
local function find(node)
  for _, c in ipairs(node:children()) do
    if c.class == "ImagePerceptor" then eye = c end
    find(c)
  end
end
find(robot)
near("the camera's vertical field of view", eye.fov, 53.1301, 1e-3)
near("its near plane", eye.zNear, 0.05, 1e-9)
near("its far plane", eye.zFar, 8, 1e-9)
