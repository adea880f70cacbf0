-- row: 12
-- input: an MJCF file with an integrator, torsional friction and firm stops, which MuJoCo alone has
-- right: each is named with its node; with `strict` the file is refused
-- engines: OdeEngine ArticulatedEngine BulletEngine
-- args: --duration 0.1
-- expect: <option> (eng_asks.xml:2:3) has no effect with
-- expect: <joint> 'elbow' (eng_asks.xml:6:7) has no effect with
-- expect: <geom> 'floor' (eng_asks.xml:4:5) has no effect with
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
local importer = get "/sys/server/scene/mjcf"
local function import() get("/usr/scene"):importScene("eng_asks.xml") end
importer.strict = true
local taken, why = pcall(import)
local engine = get("/sys/server/physics/engine").class
judge("strict refuses it, and says which engine lacks what",
      not taken and tostring(why):find("(eng_asks.xml:6:7) has no effect with " .. engine, 1, true) ~= nil)
importer.strict = false
judge("without strict it loads", (pcall(import)))
