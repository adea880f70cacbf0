-- A match of the demo team against itself, both teams inside the host, and what tools/accept wants to know of it: sparkbatch makes columns of it.
--
--     sparkbatch --config tools/acceptance/demo_team.lua --runs 10 --seed 1 --results match.csv
local kGround, kUp, kHeld = 0.25, 0.5, 0.8   -- m: a torso below is not standing (as the referee has it); s it must stand again; m: the referee holds it
local kEvery = 5                             -- cycles between two looks

league = { solver = "articulated" }          -- the same physics; --set solver=dense plays with the engine's own
include "soccer.lua"
soccerTeams("humanoid-team", "HumanoidBehavior", "Red Blue", option{ name = "eleven", default = 11, doc = "Players of each team." })
Soccer.AutomaticKickOff, Soccer.WaitBeforeKickOff = true, 5

local counts = { playerSeconds = 0, groundSeconds = 0, fouls = 0 }
for type = 0, 4 do
  for _, what in ipairs { "falls", "ups", "upSeconds", "longest" } do counts[what .. type] = 0 end
end
local result = results(counts)
local match = get "/sys/server/gamecontrol/GameStateAspect"
local penalties = get "/sys/server/gamecontrol/PenaltyAspect"
local players, ball, step = {}, nil, 0

local function lookUp()
  players = {}
  for _, agent in ipairs(get("/usr/scene"):children()) do
    local body = agent.class == "AgentAspect" and agent:find("spacenao/body")
    if body then players[#players + 1] = { body = body, type = body:find("AgentState").robotType, standing = 0 } end
  end
end

local function add(name, by) result[name] = result[name] + by end

--- A fall ends when the player has stood for a while. If the referee lifts the player, this does not count as getting
--- up.
local function look(p, seconds)
  local height = p.body.worldTransform[15]
  add("playerSeconds", seconds)
  if height < kGround then
    add("groundSeconds", seconds)
    if not p.fell then
      p.fell = step
      add("falls" .. p.type, 1)
    end
    p.standing = 0
  elseif height > kHeld then
    p.fell = nil
  elseif p.fell then
    p.standing = p.standing + seconds
    if p.standing >= kUp then
      local took = (step - p.fell) * 0.02 - p.standing
      add("ups" .. p.type, 1)
      add("upSeconds" .. p.type, took)
      result["longest" .. p.type] = math.max(result["longest" .. p.type], took)
      p.fell = nil
    end
  end
end

get("/sys/server/simulation"):on("rule", function(self, event)
  step = step + 1
  if step % kEvery ~= 0 then return end
  if match.playMode == "GameOver" then return self:stop() end
  if #players < 22 and step % 50 == 0 then lookUp() end
  local seconds = kEvery * event.step
  if match.playMode ~= "BeforeKickOff" then
    for _, p in ipairs(players) do look(p, seconds) end
  end
  result.fouls = penalties.fouls
end)
