-- row: p46
-- input: a file imports others by names beside it, above it and from the root; another one imports a file that is missing
-- right: all are there; the missing one fails the import, the rest of the file is there, unless looseImports is set
-- args: --duration 0.04
-- expect: the import of 'nowhere.rsg' failed, the rest goes on
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation()
local scene = get "/usr/scene"
get("/sys/server/scene").flattenTransforms = false
scene:importScene("rsg/agent/papers_parts/outer.rsg")
judge("beside, above, from the root",
  get("/usr/scene/outer/inner") and get("/usr/scene/outer/bare/body") and get("/usr/scene/outer/inner[2]"))
local good, why = pcall(function() scene:importScene("rsg/agent/papers_parts/broken.rsg") end)
judge("a missing one is an error: " .. tostring(why):sub(1, 100),
  not good and why:find("papers_parts/broken.rsg:4", 1, true))
judge("the rest is there", get("/usr/scene/before") and get("/usr/scene/after"))
get("/sys/server/scene/rsg").looseImports = true
judge("with looseImports it is logged", pcall(function() scene:importScene("rsg/agent/papers_parts/broken.rsg") end))
