-- row: 24
-- input: a URDF with a joint that follows another, limits, damping and friction, on engines without such joints
-- right: the log names the <mimic> with its place, as in the file, and nothing that the file does not say
-- engines: OdeEngine ArticulatedEngine BulletEngine
-- args: --duration 0.1
-- expect: /follower/echo_mimic: <mimic> (urdf/follower.urdf:10:58) has no effect with
-- never: Mujoco
-- never: MuJoCo
-- never: equality
-- never: geom
include "../lib/urdf.lua"
urdfRobot("urdf/follower.urdf", 1)
