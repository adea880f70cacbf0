-- A failing import is reported with its position and keeps the nodes created so far, like the original server.
-- expect: rsg/review/half.rsg:4:32: there is no class 'Boxx'. Did you mean 'Box'
-- expect: there: one, two.
include "house.lua"
files() scene() physics() simulation()
print(select(2, pcall(function() get("/usr/scene"):importScene("rsg/review/half.rsg") end)))
local names = {}
for _, node in ipairs(get("/usr/scene"):children()) do
  if node.class == "Transform" then table.insert(names, node.name) end
end
print("there: " .. table.concat(names, ", ") .. ".")
