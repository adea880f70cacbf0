-- A thousand imports of one file read it once.
-- expect: 1000 chairs from 1 file
include "house.lua"
files() scene() physics() simulation()
for i = 1, 1000 do
  local place = new("Transform", "/usr/scene/place" .. i)
  place.localPos = { i % 40, i // 40, 1 }
  place:importScene("rsg/review/room.rsg")
end
local importer = get("/sys/server/scene/rsg")
print(importer.imports .. " chairs from " .. importer.filesParsed .. " file")
