-- A config alone can create, attach, drive and stop joints of all kinds.
-- expect: universal 20 and 20 deg
-- expect: slider 0.30 m
-- expect: steering 15 deg, wheel 180 deg/s
-- expect: ball motor 30 deg/s
-- expect: the fixed one stays where it was, to the millimetre
-- args: --rate max --duration 4
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene/world").gravity = { 0, 0, 0 }

local function box(path, pos, mass)
  local place = new("Transform", path)
  place.localPos = pos
  place:new("RigidBody", "body"):setBoxTotal(mass, 0.2, 0.2, 0.2)
  return place
end
--- A light box half a metre above a heavy one, with a joint between them.
local x = 0
local function pair(class)
  local group = new("Transform", "/usr/scene/" .. class)
  group.localPos = { x, 0, 1 }
  x = x + 3
  box(tostring(group) .. "/base", { 0, 0, 0 }, 1e6)
  local arm = box(tostring(group) .. "/arm", { 0, 0, 0.5 }, 1)
  local joint = arm:new(class, "joint")
  joint:attach("../body", "../../base/body")
  return joint, arm
end

local universal = pair("UniversalJoint")
universal:setAnchor(0, 0, -0.25)
universal:setAxis1(1, 0, 0)
universal:setAxis2(0, 1, 0)
for axis = 0, 1 do
  universal:setLowStopDeg(axis, -20)
  universal:setHighStopDeg(axis, 20)
  universal:setMaxMotorForce(axis, 50)
  universal:setAngularMotorVelocity(axis, 60)
end

local slider = pair("SliderJoint")
slider:setLowStopPos(0, -0.3)
slider:setHighStopPos(0, 0.3)
slider:setMaxMotorForce(0, 50)
slider:setLinearMotorVelocity(0, 0.5)

local wheel = pair("Hinge2Joint")
wheel:setAnchor(0, 0, 0)
wheel:setLowStopDeg(0, -15)
wheel:setHighStopDeg(0, 15)
wheel:setMaxMotorForce(0, 50)
wheel:setAngularMotorVelocity(0, 45)
wheel:setMaxMotorForce(1, 50)
wheel:setAngularMotorVelocity(1, 180)

local ball, arm = pair("BallJoint")
ball:setAnchor(0, 0, 0)
local motor = arm:new("AngularMotor", "motor")
motor:attach("../body", "../../base/body")
motor.numAxes = 1
motor:setMotorAxis(0, 0, 0, 0, 1)
motor:setMaxMotorForce(0, 50)
motor:setAngularMotorVelocity(0, 30)

local fixed, held = pair("FixedJoint")
fixed:setFixed()
held:find("body").angularVelocity = { 1, 0, 0 }

on("rule", function(self, event)
  if event.cycle ~= 190 then return end
  print(string.format("universal %.0f and %.0f deg", universal:getAngle(0), universal:getAngle(1)))
  print(string.format("slider %.2f m", slider:getPosition()))
  print(string.format("steering %.0f deg, wheel %.0f deg/s", wheel:getAngle(0), wheel:getAngleRate(1)))
  print(string.format("ball motor %.0f deg/s", math.deg(arm:find("body").angularVelocity[3])))
  local at = held.localPos
  if math.abs(at[1]) + math.abs(at[2]) + math.abs(at[3] - 0.5) < 1e-3 then print("the fixed one stays where it was, to the millimetre") end
end)
