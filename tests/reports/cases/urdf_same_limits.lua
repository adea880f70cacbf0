-- row: 9
-- input: a pendulum whose hinge has lower = upper = 0 starts level
-- right: it has no limit, which is said, and swings down
-- engines: all
-- args: --duration 0.6
-- expect: same_limits.urdf:8:5: a <limit> whose 'lower' is not below its 'upper' counts as no limit
include "../lib/judge.lua"
include "../lib/urdf.lua"
local pendulum = urdfRobot("urdf/same_limits.urdf", 0)
-- q'' = m g l cos(q) / (I + m l^2), from rest
nearAt(0.5, "its angle", function() return pendulum:find("rod/swing"):getAngle() end, 66.4, 4)
