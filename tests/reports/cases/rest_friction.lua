-- row: 24
-- input: a block whose contacts have a coefficient of friction, on MuJoCo, which has surfaces of its own
-- right: the log names what has no effect
-- engines: MujocoEngine
-- args: --duration 0.1
-- expect: /block/shape/surface: a coefficient of friction (contactMu) has no effect with MujocoEngine
include "house.lua"
files() scene() physics(engineOption()) simulation()
local space = get "/usr/scene/space"
space:new("PlaneCollider", "ground")
local block = space:new("Transform", "block")
block.localPos = { 0, 0, 0.1 }
block:new("RigidBody", "body"):setBoxTotal(1, 0.2, 0.2, 0.2)
local shape = block:new("BoxCollider", "shape")
shape:setBoxLengths(0.2, 0.2, 0.2)
local surface = shape:new("ContactJointHandler", "surface")
surface.contactMu, surface.contactPyramid = 0.3, true
