-- Soccer as in 2004: two teams of spheres on a field of 104 x 68 m.
--
--     sparkhost --config soccer-sphere.lua                            -- waits for teams from the network
--     sparkhost --config soccer-sphere.lua --set "team=Red Blue"      -- plays by itself; --set sets any option below
--
-- Three statements are sufficient: plugin "x" loads classes, new("Class", "/path") creates a node, node.x = v sets a
-- property. The functions of the included files consist of these statements, each for one server and its helpers.
include "house.lua"
include "materials.lua"
include "soccer-house.lua"
include "shot_clock.lua"

local robots  = option{ name = "team", default = "", doc = "A team of this name plays inside the host; \"A B\": two teams." }
local players = option{ name = "players", default = 11, doc = "Players of each team inside the host." }
local offside = option{ name = "offside", default = true, doc = "Offside is judged." }
local clock   = option{ name = "shotClock", default = "off", choices = { "off", "here", "elsewhere" },
                        doc = "A side may have the ball for 5 s; judged here, or by referee.lua in another host." }
local parser  = option{ name = "parser", default = "SexpParser", doc = "Class of the language that agents speak." }
local encoder = option{ name = "monitor", default = "SexpMonitor", doc = "Class of the language that monitors hear." }

-- the servers
files()                                 -- /sys/server/file: the folder scenes/ is known as rsg/
scene()                                 -- /sys/server/scene, and an empty scene at /usr/scene
materials()                             -- /sys/server/material: names for viewers
physics(engineOption())                 -- /sys/server/physics with an engine; a world and a space in the scene
simulation()                            -- /sys/server/simulation: the run loop
agents{ parser = parser, decimals = 2 } -- /sys/server/gamecontrol with a parser, and a TCP port
monitors{ encoder = encoder }           -- /sys/server/monitor with an encoder, and a TCP port
web()                                   -- /sys/server/web: the page on which browsers show the match
control()                               -- /sys/server/control: the socket of sparkctl
drawing()                               -- /sys/server/drawing: drawings of agents for viewers
plugin "sensors"                        -- classes that robots' scene files name
plugin "effectors"

-- the match
soccerVariables {
  FieldLength = 104, FieldWidth = 68, GoalWidth = 7.32, GoalDepth = 2, GoalHeight = 0.5, BorderSize = 10,
  PenaltyLength = 16.5, PenaltyWidth = 33, FreeKickDistance = 9.15, FreeKickMoveDist = 10,
  AgentRadius = 0.22, AgentMass = 75, AgentMaxSpeed = 10, AgentLinearDrag = 600,
  BallRadius = 0.111, BallMass = 0.425878, BallLinearDrag = 0.1, BallAngularDrag = 0.001, BallMaxSpeed = 40,
  RuleHalfTime = 480, RuleDropBallTime = 30, WaitBeforeKickOff = 2, AutomaticKickOff = true,
  MaxRobotTypeCount = 11, MinRobotTypesCount = 1, MaxSumTwoRobotTypes = 22,   -- all spheres are of one type
  MaxPlayersInsideOwnArea = 11,
}
soccerRules()                           -- control aspects below /sys/server/gamecontrol; one more:
if offside then new("OffsideAspect", "/sys/server/gamecontrol/OffsideAspect") end
if clock ~= "off" then new("Variables", "/sys/variables/ShotClock") end
if clock == "here" then shotClock(get("/sys/server/gamecontrol")) end
soccerMonitor()                         -- monitor items and trainer commands
get("/sys/server/monitor/GameStateItem").areas = true
get("/usr/scene"):importScene("rsg/soccer/field_2004.rsg")

soccerTeams("sphere-team", "SphereBehavior", robots, players)   -- inside the host, if any; others come over the network
