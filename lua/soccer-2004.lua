-- The league of 2004 with agents of its time: the host starts them from an agent database, and each act takes effect in
-- simulated time, whatever the machine does.
--
--     sparkhost --config soccer-2004.lua --set agentDatabase=agentdb.xml --set "agents=red blue" --rate max --duration 600
--
-- Every agent senses each 0.2 s; sensations and acts take 0.1 s. docs/engines-of-time.md says more.
include "house.lua"
include "materials.lua"
include "soccer-house.lua"

local types   = option{ name = "agents", default = "", doc = "Agent types of the database; \"A B\": eleven of each, with `players`." }
local players = option{ name = "players", default = 11, doc = "Agents of each type." }
local random  = option{ name = "randomField", default = false,
                        doc = "As then, the size of the field and the mass of the ball are random (by the seed)." }
local create  = option{ name = "createEffector", default = "CreateEffector",
                        doc = "How agents get spheres: CreateEffector by (create), SceneEffector by (scene FILE)." }
local offside = option{ name = "offside", default = true, doc = "Offside is judged." }

files() scene() materials() physics(engineOption())
simulation().step = 0.01
spades{ types = types, players = players, effector = create }
monitors{ encoder = "SexpMonitor" }
web() control()
plugin "sensors" plugin "effectors"

-- the match
local function drawn(least, most, usual) return random and least + (most - least) * math.random() or usual end
soccerVariables {
  FieldLength = drawn(100, 110, 105), FieldWidth = drawn(64, 75, 68),
  GoalWidth = 7.32, GoalDepth = 2, GoalHeight = 0.5, BorderSize = 10,
  PenaltyLength = 16.5, PenaltyWidth = 33, FreeKickDistance = 9.15, FreeKickMoveDist = 10,
  AgentRadius = 0.22, AgentMass = 75, AgentMaxSpeed = 10, AgentLinearDrag = 12,
  BallRadius = 0.111, BallMass = drawn(0.41, 0.45, 0.43), BallLinearDrag = 0.3, BallAngularDrag = 0.001, BallMaxSpeed = 40,
  RuleHalfTime = 300, RuleDropBallTime = 30, WaitBeforeKickOff = 2, AutomaticKickOff = true,
  MaxRobotTypeCount = 11, MinRobotTypesCount = 1, MaxSumTwoRobotTypes = 22,
  MaxPlayersInsideOwnArea = 11, SayMsgSize = 512,
  LongNames = true, ReportScore = false, LabelMessages = false,       -- percepts as agents knew them until 2007
}
soccerRules()
if offside then new("OffsideAspect", "/sys/server/gamecontrol/OffsideAspect") end
soccerMonitor()
get("/sys/server/monitor/GameStateItem").areas = true
get("/usr/scene"):importScene("rsg/soccer/field_2004.rsg")

if create ~= "CreateEffector" then return end

-- An agent sends (create) and gets its sphere.
local creator = new("ScriptAspect", "/sys/server/gamecontrol/creator")
creator:on("agentConnected", function(self, event)
  local create = get(event.data):find("_CreateEffector")
  create.scene, create.limit = "rsg/agent/sphere_2004.rsg", 1
end)
