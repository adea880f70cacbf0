-- A referee in a process of its own. It mounts a match that runs elsewhere, and judges by the shot clock there:
--
--     sparkhost --config soccer-sphere.lua --set "team=Red Blue" --set shotClock=elsewhere \
--               --set remoteAddress=127.0.0.1:3400 --set remoteToken=a-long-secret-word
--     sparkhost --config referee.lua --set match=127.0.0.1:3400 --set token=a-long-secret-word
--
-- The match waits for it in each cycle, as it waits for its own rules; without it, it goes on. `--set shotClock=here`
-- is the same rule inside the match: in lockstep, or with --rate max, the match is the same to the last bit.
include "house.lua"
include "shot_clock.lua"

local at    = option{ name = "match", default = "127.0.0.1:3400", doc = "Where the host of the match listens: host:port or a Unix socket." }
local token = option{ name = "token", default = "", secret = true, doc = "The token that it printed." }

simulation()
local match = mount{ "/usr/match", address = at, token = token, name = "referee" }
shotClock(match:find("sys/server/gamecontrol"))
match:on("remoteLost", function() get("/sys/server/simulation"):stop() end)   -- the match is over
