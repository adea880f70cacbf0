-- Soccer of the 3D league at maximum speed, for training: the rules and robots of soccer.lua, the articulated solver,
-- and a clock that waits only for the agents.
--
--     sparkhost --config training.lua --expect 22
--
-- All options of soccer.lua are available; `--set solver=dense --set exactReplay=true` reproduces its physics to the
-- last digit.
league = { solver = "articulated" }
include "soccer.lua"

local loop = get "/sys/server/simulation"
loop.rate, loop.sync = "max", true               -- lockstep: a cycle starts when every agent has answered with (syn)
Soccer.AutomaticKickOff = true
