-- row: 11
-- input: a URDF robot at rest with four sensors: in its link, turned by a pose, in a fixed link, and both
-- right: gravity along the axis that points up of each
-- engines: all
-- args: --duration 1.5
-- never: is not supported
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics(engineOption()) simulation() agents{ port = 0 }
plugin "sensors" plugin "effectors"
get("/sys/server/scene/urdf").strict = true
get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false
local robot = new("AgentAspect", "/usr/scene/space/robot")
robot:importScene("sense_imus.urdf")
watch(robot, function(seen, time)
  if not isAt(time, 1.4) then return end
  local up = { flat = { 0, 0, 1 }, rolled = { 0, 1, 0 }, deep = { -1, 0, 0 }, back = { 0, 0, 1 } }
  for name, axis in pairs(up) do
    local a = seen["ACC " .. name .. "_acc"][3]
    for i = 1, 3 do near(name .. " " .. i, a[i + 1], 9.81 * axis[i], 0.1) end
  end
end)
