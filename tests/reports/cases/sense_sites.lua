-- row: 11
-- input: a MJCF model at rest with accelerometers at sites, one turned by 90 degrees, a rangefinder, cutoff and noise
-- right: each in the frame of its site; cutoff and noise act
-- engines: all
-- args: --duration 1.5
-- never: is not supported
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics(engineOption()) simulation() agents{ port = 0 }
plugin "sensors" plugin "effectors"
get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false
local robot = new("AgentAspect", "/usr/scene/space/robot")
robot:importScene("sense_sites.xml")
local wall = new("Transform", "/usr/scene/space/wall")
wall.localPos = { 2.5, 0, 1 }
wall:new("BoxCollider", "box").boxLengths = { 1, 2, 2 }
local spread = 0
watch(robot, function(seen, time)
  if seen["GYR shaky"] then spread = math.max(spread, math.abs(seen["GYR shaky"][3][2])) end
  if not isAt(time, 1.4) then return end
  near("plain z", seen["ACC plain"][3][4], 9.81, 0.1)
  near("turned y", seen["ACC turned"][3][3], 9.81, 0.1)
  near("turned z", seen["ACC turned"][3][4], 0, 0.1)
  near("within its cutoff", seen["ACC weak"][3][4], 4, 1e-6)
  near("the wall", seen["DST far"][3][2], 2, 0.03)
  judge("the gyroscope has noise: " .. spread, spread > 5 and spread < 90)
end)
