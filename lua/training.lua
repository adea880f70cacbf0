-- Soccer of the 3D league as fast as it goes, for training: the rules and robots of soccer.lua, physics by the
-- articulated solver, and a clock that waits for the agents only.
--
--     sparkhost --config training.lua --expect 22
--
-- --set changes whatever soccer.lua lets it change; `--set solver=dense --set exactReplay=true` gives its physics to
-- the last digit.
league = { solver = "articulated" }
include "soccer.lua"

local loop = get "/sys/server/simulation"
loop.rate, loop.sync = "max", true               -- lockstep: a cycle starts when every agent has answered with (syn)
Soccer.AutomaticKickOff = true
