-- row: 1
-- input: joints that are driven at 0.2 deg/s or 2 mm/s, more slowly than the speed of sleep: a motor, a controller, a
--    force against damping, a damped spring, a slider with a load on it
-- right: they get to where they are due
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
local speed = 0.2
local function arm(y)
  local place = new("Transform", "/usr/scene/arm" .. y)
  place.localPos = { 0.4, y, 1 }
  local body = place:new("RigidBody", "body")
  body:setBoxTotal(1, 0.8, 0.1, 0.1)
  local hinge = place:new("HingeJoint", "hinge")
  hinge:attach("../body", "")
  hinge:setAnchor(-0.4, 0, 0)
  hinge:setAxis(0, 0, 1)
  return hinge
end
local motor, controller, damped, spring = arm(0), arm(3), arm(6), arm(9)
motor:setAngularMotorVelocity(0, speed)
motor:setMaxMotorForce(0, 100)
controller:setController(0, 0, 10, 0, math.rad(speed), 0, 100)
damped:setDamping(0, 50)
damped:setController(0, 0, 0, 0, 0, 50 * math.rad(speed), 1000)
spring:setDamping(0, 500)
spring:setSpring(0, 1, 1)
local lift = new("Transform", "/usr/scene/lift")
lift.localPos = { 0, 20, 1 }
lift:new("RigidBody", "body"):setBoxTotal(10, 1, 1, 0.1)
local board = lift:new("BoxCollider", "board")
board.boxLengths = { 1, 1, 0.1 }
local slider = lift:new("SliderJoint", "slider")
slider:attach("../body", "")
slider:setLinearMotorVelocity(0, 0.002)
slider:setMaxMotorForce(0, 10000)
slider:setCFM(0, 1e-9)
local load = new("Transform", "/usr/scene/load")
load.localPos = { 0.2, 20, 1.149 }
local crate = load:new("RigidBody", "body")
crate:setBoxTotal(50, 0.2, 0.2, 0.2)
load:new("BoxCollider", "box").boxLengths = { 0.2, 0.2, 0.2 }
for _, collider in ipairs{ board, get "/usr/scene/load/box" } do
  collider:new("ContactJointHandler", "surface").contactBounceMode = false
end
local before
on("rule", function(_, event)
  if math.abs(event.time - 2) < 0.001 then before = crate.position[3] end
  if math.abs(event.time - 6) > 0.001 then return end
  near("the motor's angle", motor:getAngle(), 6 * speed, 0.03)
  near("the controller's", controller:getAngle(), 6 * speed, 0.03)
  near("that of a force against damping", damped:getAngle(), 6 * speed, 0.03)
  near("that of a damped spring", spring:getAngle(), math.deg(1 - math.exp(-6 / 500)), 0.01)
  near("the slider's position", slider:getPosition(), 0.012, 2e-4)
  near("how far its load has risen in 4 s", crate.position[3] - before, 0.008, 2e-4)
end)
