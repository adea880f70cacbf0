-- A config alone can create, attach and move a joint.
-- expect: the arm stopped at 30 deg
-- args: --rate max --duration 2
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene/world").gravity = { 0, 0, 0 }

local function box(name, z, mass)
  local place = new("Transform", "/usr/scene/" .. name)
  place.localPos = { 0, 0, z }
  place:new("RigidBody", "body"):setBoxTotal(mass, 0.2, 0.2, 0.2)
  return place
end
box("base", 0, 1000)
local arm = box("arm", 0.5, 1)

local joint = arm:new("HingeJoint", "shoulder")
joint:attach("../body", "../../base/body")
joint:setAnchor(0, 0, -0.25)
joint:setAxis(1, 0, 0)
joint:setHighStopDeg(0, 30)
joint:setLowStopDeg(0, -30)
joint:setMaxMotorForce(0, 50)
joint:setAngularMotorVelocity(0, 90)

on("rule", function(self, event)
  if event.cycle == 90 then print(string.format("the arm stopped at %.0f deg", joint:getAngle())) end
end)
