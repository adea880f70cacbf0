-- row: pF1
-- input: in a run a script makes a file system by its class object, imports a file from it, and deletes it
-- right: the file is found while the file system is there, and is missing afterwards
-- args: --duration 0.3
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation()
local name = "own/rsg/agent/papers_bare.rsg"
local function import() return pcall(function() get("/usr/scene"):importScene(name) end) end
on("rule", function(self, event)
  if event.cycle ~= 5 then return end
  judge("it is not there before", not import())
  local own = get("/classes/DirectoryFileSystem"):new("/sys/server/file/own")
  own:setPath(host.scenePaths[1])
  own.prefix = "own/"
  judge("it is there with the file system", import() and get("/usr/scene/bare/body"))
  own:delete()
  judge("it is not there afterwards", not import())
end)
