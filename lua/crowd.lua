-- A crowd of sphere agents on a field that grows with it, for measurements and your own swarms: no referee and no
-- halves; the range of vision is `range`.
--
--     sparkhost --config crowd.lua --set agents=1000
--
-- Agents join as in soccer: (scene rsg/agent/sphere.rsg), then (init (unum n)(teamname A)) or B, which places them side
-- by side on the field, and (drive x y z) from then on. They connect over the network, or run as behaviours below
-- /usr/agent.
include "house.lua"
include "materials.lua"
include "soccer-house.lua"

local agentCount = option{ name = "agents", default = 100, doc = "So many agents find room; half of them in each of two teams." }
local range      = option{ name = "range", default = 10.0, doc = "How far they see [m]; 0: without limit." }
local room       = option{ name = "room", default = 64.0, doc = "Ground for each of them [m2]." }

local apart = 0.9 * math.sqrt(room)
local width = math.sqrt(room * agentCount) + apart
local team  = math.max(11, (agentCount + 1) // 2)

-- the servers
files()
scene()
materials()
physics()
simulation()
agents{}.maxAgents = agentCount
get("/sys/server/net/agents").maxConnections = agentCount
monitors{}
web()
control()
plugin "sensors"
plugin "effectors"

-- the field and the teams
soccerVariables {
  FieldLength = width, FieldWidth = width, GoalWidth = 7.32, GoalDepth = 2, GoalHeight = 0.5, BorderSize = 10,
  AgentRadius = 0.22, AgentMass = 75, AgentMaxSpeed = 10, AgentLinearDrag = 600,
  BallRadius = 0.111, BallMass = 0.425878, BallLinearDrag = 0.1, BallAngularDrag = 0.001,
  TeamSize = team, StartDistance = apart, MaxRobotTypeCount = team, MinRobotTypesCount = 1, MaxSumTwoRobotTypes = 2 * team,
  VisionRange = range,
}
for _, class in ipairs { "TeamlessAspect", "GameStateAspect", "BallStateAspect" } do new(class, "/sys/server/gamecontrol/" .. class) end
soccerMonitor()
get("/usr/scene"):importScene("rsg/soccer/field_2004.rsg")
