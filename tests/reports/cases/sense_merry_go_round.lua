-- row: 13
-- input: accelerometers at the hub, on the edge and above the edge of a disk that turns, on a world with 3.7 m/s^2
-- right: centripetal acceleration by the place of each, the world's gravity, the directions of its own frame
-- engines: all
-- args: --duration 1
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics(engineOption()) simulation() agents{ port = 0 }
plugin "sensors"
get("/usr/scene/world").gravity = { 0, 0, -3.7 }
local disk = new("Transform", "/usr/scene/disk")
disk.localPos = { 2, -1, 4 }
local body = disk:new("RigidBody", "body")
body:setCylinderTotal(8, 0.6, 0.1)
local axle = disk:new("HingeJoint", "axle")
axle:attach("../body", "")
axle:setAnchor(0, 0, 0)
axle:setAxis(0, 0, 1)
body.angularVelocity = { 0, 0, 6 }
local agent = disk:new("AgentAspect", "agent")
agent:new("Accelerometer", "hub")
local edge = agent:new("Transform", "edge")
edge.localPos = { 0, 0.5, 0 }
edge:new("Accelerometer", "edge")
local outer = edge:new("Transform", "outer")           -- nested: 0.75 m from the axle, its x axis to the axle
outer.localPos = { 0, 0.25, 0.3 }
outer:setLocalRotation(0, 0, -90)
outer:new("Accelerometer", "outer")
watch(agent, function(seen, time)
  if not isAt(time, 0.5) then return end
  local function three(name, x, y, z)
    local a = seen["ACC " .. name][3]
    near(name .. " x", a[2], x, 0.05)
    near(name .. " y", a[3], y, 0.05)
    near(name .. " z", a[4], z, 0.05)
  end
  three("hub", 0, 0, 3.7)
  three("edge", 0, -36 * 0.5, 3.7)
  three("outer", 36 * 0.75, 0, 3.7)
end)
