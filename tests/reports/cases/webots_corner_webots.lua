-- row: 11
-- input: a robot with a rangefinder and an IMU that does not move, and a wall of the same file, of webots
-- right: it sees the wall at 2.5 m, not its own shapes; the IMU senses gravity along its y axis, and no rates
-- engines: all
-- args: --duration 0.2
-- never: is not supported
include "../lib/corner.lua"
judgeCorner({ "ACC rolled", "GYR still", "DST ahead" }, "webots/corner.wbt", "", "fixed")
