-- A position that is no number, or beyond all bounds, ends the import with its place in the file.
-- expect: nowhere.rsg:3:5: cannot call setLocalPos
-- expect: far.rsg:2:27:
-- expect: found inf 0.0 0.0
-- expect: from 1e9
include "house.lua"
files() scene() physics() simulation()
for _, file in ipairs{ "rsg/review/nowhere.rsg", "rsg/review/far.rsg" } do
  print(select(2, pcall(function() get("/usr/scene"):importScene(file) end)))
end
