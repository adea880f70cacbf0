-- row: 18
-- input: two opponents kick, or touch, the ball in the same cycle, and it leaves the field: one is nearer, or both
--   are as near
-- right: the nearer one touched it last; of two that are as near each about half of the times, whichever joined first
-- args: --agent-port 0 --monitor-port 0 --web-port 0 --duration 60
include "soccer-sphere.lua"
include "../lib/judge.lua"
include "../lib/soccer.lua"

local state = get "/sys/server/gamecontrol/BallStateAspect"
local game = get "/sys/server/gamecontrol/GameStateAspect"
local kicks, quiet = false, {}
for i, team in ipairs { "Red", "Blue" } do
  player { name = "p" .. i, team = team, unum = 1,
           think = function() return kicks and "(kick 0 20)" or "(drive 0 0 0)" end }
end

--- Removes the noise of a robot's kicks, so that mirrored players do mirrored things.
local function silence(path)
  local function walk(node)
    if node:isA "KickEffector" then node:setNoiseParams(0, 0, 0, 0) end
    for _, child in ipairs(node:children()) do walk(child) end
  end
  if not quiet[path] then walk(get(path)) quiet[path] = true end
end

-- Each duel: how, and by how much the first player is farther from the ball than the second [m].
local duels = {}
for _, how in ipairs { "kick", "touch" } do
  for _ = 1, 6 do
    duels[#duels + 1] = { how, 0.01 }
    duels[#duels + 1] = { how, -0.01 }
  end
  for _ = 1, 40 do duels[#duels + 1] = { how, 0 } end
end

local n, wrong, draws = 0, 0, { kick = { 0, 0 }, touch = { 0, 0 } }
local period, acts, judges = 24, 10, 13           -- cycles; a kick lasts ten
on("prepare", function(self, event)
  local ball, a, b = body "/usr/scene/Ball", robot(1), robot(2)
  if event.cycle < 72 or n > #duels or not (ball and a and b) then return end
  silence "/usr/scene/AgentAspect1"
  silence "/usr/scene/AgentAspect2"
  local phase = event.cycle % period
  if phase == 0 then
    n = n + 1
    if n > #duels then
      judge(wrong .. " of 24 duels not for the nearer one", wrong == 0)
      for how, won in pairs(draws) do
        judge(("%s as near: %d for the one that joined first, %d for the other"):format(how, won[1], won[2]),
              won[1] + won[2] == 40 and won[1] >= 10 and won[2] >= 10)
      end
      get("/sys/server/simulation"):stop()
      return
    end
  end
  local how, more = duels[n][1], duels[n][2]
  local side = n % 4 < 2 and 1 or -1              -- they change places
  local apart = how == "touch" and 0.29 or 0.34   -- a touch: they overlap with the ball
  kicks = how == "kick" and phase == acts - 2     -- takes effect two cycles later
  if phase <= acts then
    game.playMode = "PlayOn"
    local away = phase < acts and (how == "touch" or phase < acts - 1) and 3 or 0
    place(ball, 0, 20, 0.111)
    place(a, side * (apart + math.max(more, 0) + away), 20)
    place(b, -side * (apart + math.max(-more, 0) + away), 20)
  elseif phase == judges then
    local first = state.lastTeam == "left"
    if more == 0 then
      local won = draws[how]
      won[first and 1 or 2] = won[first and 1 or 2] + 1
    elseif first ~= (more < 0) then
      wrong = wrong + 1
    end
  end
end)
