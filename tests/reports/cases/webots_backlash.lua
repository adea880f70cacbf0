-- row: 8
-- input: a robot of the humanoid league in its own file: a template in Lua of R2021b, whose servos have play
-- right: its limbs hang on hinges with the masses of the gears, down is where its feet are
-- args: --duration 0.1
-- expect: a HingeJointWithBacklash is a HingeJoint without play; its gears move with its endPoint (and 1 more)
include "../lib/judge.lua"
include "../lib/webots.lua"
webotsCase()
judge("the robot is read", imports("webots/protos/Walker.proto"))
local walker = get "/usr/scene/walker"
near("the bodies", #all(walker, "RigidBody"), 3, 0)
near("the hinges", #all(walker, "HingeJoint"), 2, 0)
local mass = 0
for _, body in ipairs(all(walker, "RigidBody")) do mass = mass + body.mass end
near("the mass", mass, 1 + 0.5 + 0.05 + 0.3 + 0.01, 1e-6)
near("the height of the shin over the trunk", all(walker, "RigidBody")[3].position[3], -0.4, 0.01)
