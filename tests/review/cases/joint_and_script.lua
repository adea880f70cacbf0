-- attachScript attaches a script to a joint, and an error about the joint's own attach says so.
-- expect: attach is a method of class HingeJoint itself: write node:attachScript("scripts/count.lua") to attach a script to /usr/scene/arm/shoulder
-- expect: the script of /usr/scene/arm/shoulder runs in cycle 3
-- expect: the script of /usr/scene/arm runs in cycle 3
include "house.lua"
files() scene() physics() simulation()
local arm = new("Transform", "/usr/scene/arm")
arm:new("RigidBody", "body"):setBoxTotal(1, 0.2, 0.2, 0.2)
local joint = arm:new("HingeJoint", "shoulder")
print(select(2, pcall(function() joint:attach("scripts/count.lua") end)))
joint:attachScript("scripts/count.lua")
arm:attach("scripts/count.lua")
