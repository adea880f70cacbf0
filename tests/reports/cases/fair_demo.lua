-- row: 24
-- input: the log of a match of the demo teams
-- right: joins, play modes and goals, and no warnings about their own kicks
-- args: --agent-port 0 --monitor-port 0 --web-port 0 --duration 60
-- expect: plays for 'Red' (left) with number 11
-- expect: KickOff_Left after BeforeKickOff
-- expect: "teams":["Red","Blue"]
-- never: warning
include "soccer-sphere.lua"
soccerTeams("sphere-team", "SphereBehavior", "Red Blue", 11)
