-- Creating very many nodes takes linear time, and the depth of the tree is limited.
-- expect: made 300000
-- expect: the tree is at most 1000 levels deep
-- expect: "cycles":5,
-- args: --rate max --duration 0.1
include "house.lua" files() scene() simulation()
for i = 1, 300000 do new("Node", "/usr/n/" .. i) end
print("made " .. #get("/usr/n"):children())
local at = new("Node", "/usr/deep")
print(select(2, pcall(function() for i = 1, 5000 do at = at:new("Node", "d") end end)))
