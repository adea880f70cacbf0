-- row: 17
-- input: a match of the demo teams with a change of sides at half time of which agents are not notified
-- right: both kick-offs are taken as soon, since the teams see which goal is their own
-- args: --agent-port 0 --monitor-port 0 --web-port 0 --duration 30 --set silent=true
include "fair_sides.lua"
