-- A side that has the ball for 5 s loses it by the shot clock, which says whose it was.
-- expect: s, free_kick_right after PlayOn
-- expect: shot clock: left had the ball for 5 s
-- args: --rate max --seed 1 --duration 15 --agent-port 0 --monitor-port 0 --set web=false --set team=Red --set shotClock=here --set Soccer.AutomaticKickOff=true
include "soccer-sphere.lua"
