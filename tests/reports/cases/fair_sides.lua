-- row: 17
-- input: a match of the demo teams with a change of sides at half time, announced by Soccer.AnnounceSides, or silent
--   as in the installed base
-- right: the team that is due takes its kick-off in the second half as soon as in the first, not after a drop ball 30
--   s later
-- args: --agent-port 0 --monitor-port 0 --web-port 0 --duration 30
local silent = option{ name = "silent", default = false, doc = "Agents are not notified, as in the installed base." }
include "soccer-sphere.lua"
include "../lib/judge.lua"

local soccer = get "/sys/variables/Soccer"
soccer.RuleHalfTime, soccer.ChangeSidesInSecondHalf, soccer.AnnounceSides = 6, true, not silent
soccerTeams("sphere-team", "SphereBehavior", "Red Blue", 11)

local game = get "/sys/server/gamecontrol/GameStateAspect"
local began, taken = {}, {}
on("publish", function(self, event)
  local half, mode = game.half, game.playMode
  if mode:find "KickOff_" then began[half] = began[half] or event.time end
  if mode == "PlayOn" and began[half] then taken[half] = taken[half] or event.time - began[half] end
  if mode ~= "GameOver" then return end
  judge("sides changed: " .. game.teamLeft .. " on the left", game.teamLeft == "Blue")
  for h = 1, 2 do
    judge(("kick-off of half %d is taken after %.2f s"):format(h, taken[h] or -1), taken[h] ~= nil and taken[h] < 5)
  end
  get("/sys/server/simulation"):stop()
end)
