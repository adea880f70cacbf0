-- A position that is not finite or too large ends the import with its position in the file.
-- expect: rsg/review/nowhere.rsg:3:30: expected a position of finite numbers from -1e9 to 1e9, found nan 0.0 1.0
-- expect: rsg/review/far.rsg:2:29: expected a position of finite numbers from -1e9 to 1e9, found inf 0.0 0.0
include "house.lua"
files() scene() physics() simulation()
for _, file in ipairs{ "rsg/review/nowhere.rsg", "rsg/review/far.rsg" } do
  print(select(2, pcall(function() get("/usr/scene"):importScene(file) end)))
end
