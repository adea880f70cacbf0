-- row: A4
-- input: every property and method of bodies, colliders, joints, motors, controllers, handlers, the world and the
--   engine gets a few numbers that no engine can compute with
-- right: each is refused or survived: all bodies stay where numbers are, and the host lives
-- engines: all
-- args: --duration 1e6 --log-level error
-- expect: right: trials
QUICK = true
include "numbers.lua"
