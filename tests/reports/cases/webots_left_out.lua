-- row: 8
-- input: a robot with a mirror, a flat box, missing meshes and PROTOs, an axis of length 0 and unknown fields
-- right: what is bad is left out and named with its place, the robot is there; with strict it is refused
-- args: --duration 0.1
-- expect: webots/flawed.wbt:8:22: a shape is left out: expected three lengths above 0 for 'size' of Box
-- expect: webots/flawed.wbt:10:5: a node 'Bumper' is empty: its PROTO is not there
-- expect: webots/flawed.wbt:12:46: expected an axis that is not 0
-- expect: expected 'minStop' not above 'maxStop', found 2 and 1
-- expect: webots/flawed.wbt:12:77: the field 'squeak' of HingeJointParameters is not supported
-- expect: webots/flawed.wbt:15:27: expected the name of a node that a DEF before this place ends, found 'NOTHING'
-- expect: cannot read the mesh 'not_there.stl'
-- expect: expected two vectors for 'inertiaMatrix', found 3 numbers
-- expect: webots/flawed.wbt:20:3: the field 'upholstery' of Robot is not supported
include "../lib/judge.lua"
include "../lib/webots.lua"
webotsCase()
local good, message = imports("webots/flawed.wbt", true)
judge("strict refuses: " .. tostring(message):match("[^\n]*"), not good)
judge("the world has nothing of it", not get("/usr/scene"):find("cart"))
judge("the robot is read", imports("webots/flawed.wbt"))
local cart = get "/usr/scene/cart"
near("the bodies", #all(cart, "RigidBody"), 2, 0)
near("the spheres that collide", #all(cart, "SphereCollider"), 2, 0)
near("the boxes that collide", #all(cart, "BoxCollider"), 1, 0)
near("the hinges", #all(cart, "HingeJoint"), 1, 0)
