-- Soccer of the 3D league: 30 x 20 m, humanoids. Robots are scene files that agents name; --scene-path adds folders
-- with further ones.
--
--     sparkhost --config soccer.lua                                   -- waits for teams from the network
--     sparkhost --config soccer.lua --set "team=Red Blue" --set Soccer.AutomaticKickOff=true    -- plays by itself
--
-- Another league sets `league` and includes this file: `league.variables` are the Soccer.* values in which it differs,
-- `league.compat` is the version that it follows, and `league.solver` is the default physics solver.
local league = league or {}

include "house.lua"
include "materials.lua"
include "naotypes.lua"
include "soccer-house.lua"

local robots  = option{ name = "team", default = "", doc = "A team of this name plays inside the host; \"A B\": two teams." }
local players = option{ name = "players", default = 11, doc = "Players of each team inside the host." }
local field   = option{ name = "scene", default = "rsg/soccer/field.rsg", doc = "The field's scene file." }
local parser  = option{ name = "parser", default = "SexpParser", doc = "Class of the language that agents speak." }
local encoder = option{ name = "monitor", default = "SexpMonitor", doc = "Class of the language that monitors hear." }
local compat  = compatOption(league.compat)
local offside = option{ name = "offside", default = false, doc = "Offside is judged, unlike in the installed base." }

local engine  = engineOption(league.solver)
local cameras = option{ name = "cameras", default = false, doc = "Cameras of robots (ImagePerceptor) have pictures." }
local exact   = option{ name = "exactReplay", default = engine == "OdeEngine",
                        doc = "Physics repeats recorded sessions of the installed base to the last digit (OdeEngine)." }

-- the servers
files()
scene()
materials()
physics(engine, { exactReplay = exact })
simulation()
agents{ parser = parser, decimals = 2 }
monitors{ encoder = encoder }
web()
control()
drawing()
plugin "sensors"
plugin "effectors"
if cameras then camera() end

-- the match
naoVariables()
soccerVariables(league.variables)
soccerRules()
if offside then new("OffsideAspect", "/sys/server/gamecontrol/OffsideAspect") end
soccerFouls()
soccerMonitor()
soccerCompat(compat)
get("/usr/scene"):importScene(field)

soccerTeams("humanoid-team", "HumanoidBehavior", robots, players)   -- inside the host, if any; others come over the network
