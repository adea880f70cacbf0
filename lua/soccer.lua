-- Soccer of the 3D league: 30 x 20 m, humanoids. Robots are scene files that agents name; --scene-path says where others than Spark's are.
--
--     sparkhost --config soccer.lua
--
-- Another league sets `league` and includes this file: `league.variables` are the Soccer.* in which it differs, `league.compat` is the
-- version that it follows unless --set says otherwise.
local league = league or {}

include "house.lua"
include "materials.lua"
include "naotypes.lua"
include "soccer-house.lua"

local field   = option{ name = "scene", default = "rsg/soccer/field.rsg", doc = "The field's scene file." }
local parser  = option{ name = "parser", default = "SexpParser", doc = "Class of the language that agents speak." }
local encoder = option{ name = "monitor", default = "SexpMonitor", doc = "Class of the language that monitors hear." }
local compat  = compatOption(league.compat)

local exact   = option{ name = "exactReplay", default = true, doc = "Physics repeats recorded sessions of the installed base to the last digit." }

-- the rooms
files()
scene()
materials()
physics("OdeEngine", { exactReplay = exact })
simulation()
agents{ parser = parser }
monitors{ encoder = encoder }
control()
plugin "sensors"
plugin "effectors"

-- the match
naoVariables()
soccerVariables(league.variables)
soccerRules()
soccerFouls()
soccerMonitor()
soccerCompat(compat)
get("/usr/scene"):importScene(field)
