-- row: 18
-- input: a goalie catches and an opponent kicks in the same cycle, in either penalty area: one is nearer, or neither
-- right: the nearer one acts; of two that are as near each about half of the times, whichever joined first
-- args: --agent-port 0 --monitor-port 0 --web-port 0 --duration 60
include "soccer-sphere.lua"
include "../lib/judge.lua"
include "../lib/soccer.lua"

local state = get "/sys/server/gamecontrol/BallStateAspect"
local game = get "/sys/server/gamecontrol/GameStateAspect"
local acting = {}                                 -- what each player does
for i, team in ipairs { "Red", "Blue" } do
  player { name = "p" .. i, team = team, unum = 1, think = function() return acting[i] or "(drive 0 0 0)" end }
end

-- Each duel: the goalie, 1 is the first that joined, and by how much it is farther from the ball than the other [m].
local duels = {}
for goalie = 1, 2 do
  for _ = 1, 6 do
    duels[#duels + 1] = { goalie, 0.01 }
    duels[#duels + 1] = { goalie, -0.01 }
  end
  for _ = 1, 40 do duels[#duels + 1] = { goalie, 0 } end
end

local n, wrong, draws = 0, 0, { { catch = 0, kick = 0 }, { catch = 0, kick = 0 } }
local period, acts, judges = 24, 10, 13           -- cycles; a kick lasts ten
on("prepare", function(self, event)
  local ball, robots = body "/usr/scene/Ball", { robot(1), robot(2) }
  if event.cycle < 72 or n > #duels or not (ball and robots[1] and robots[2]) then return end
  local phase = event.cycle % period
  if phase == 0 then
    n = n + 1
    if n > #duels then
      judge(wrong .. " of 24 duels not for the nearer one", wrong == 0)
      for goalie, won in ipairs(draws) do
        judge(("as near, the goalie joined as number %d: %d caught, %d kicked"):format(goalie, won.catch, won.kick),
              won.catch + won.kick == 40 and won.catch >= 10 and won.kick >= 10)
      end
      get("/sys/server/simulation"):stop()
      return
    end
  end
  local goalie, more = duels[n][1], duels[n][2]
  local other = 3 - goalie
  local x = goalie == 1 and -45 or 45
  local out = n % 2 == 0 and 1 or -1              -- they change places
  local both = phase == acts - 2                  -- takes effect two cycles later
  acting = { [goalie] = both and "(catch)" or nil, [other] = both and "(kick 0 20)" or nil }
  if phase <= acts then
    game.playMode = "PlayOn"
    local away = phase < acts - 1 and 3 or 0
    place(ball, x, 0, 0.111)
    place(robots[goalie], x, out * (0.345 + math.max(more, 0) + away))
    place(robots[other], x, -out * (0.345 + math.max(-more, 0) + away))
    for _, b in ipairs { ball, robots[1], robots[2] } do b.angularVelocity = { 0, 0, 0 } end
  elseif phase == judges then
    local caught = state.lastTeam == (goalie == 1 and "left" or "right")
    if more == 0 then
      local won = draws[goalie]
      won[caught and "catch" or "kick"] = won[caught and "catch" or "kick"] + 1
    elseif caught ~= (more < 0) then
      wrong = wrong + 1
    end
  end
end)
