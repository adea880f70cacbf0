-- A folder is no scene, and a scene does not remove the node that it is imported into; the run goes on.
-- expect: expected a file, found a folder: 'rsg/review' in folder
-- expect: rsg/review/root_removed.rsg:4:4: a scene cannot remove the node that it is imported into
-- expect: the scene is there: /usr/scene
-- expect: "cycles":5,
-- args: --rate max --duration 0.1
include "house.lua"
files() scene() simulation()
for _, name in ipairs{ "rsg/review", "rsg/review/root_removed.rsg" } do
  print(select(2, pcall(function() get("/usr/scene"):importScene(name) end)))
end
print("the scene is there: " .. tostring(get("/usr/scene")))
