-- row: 8
-- input: the crate with bad parts, the pendulum with limits that are the same, and unknown elements, with strict
-- right: each is refused, with the place of what is wrong
include "../lib/judge.lua"
include "house.lua"
files() scene() physics() simulation()
get("/sys/server/scene/urdf").strict = true
local place = new("Transform", "/usr/scene/space/place")
for file, message in pairs{
  ["urdf/crate/crate.urdf"] = "crate.urdf:11:26: a <collision> is left out",
  ["urdf/same_limits.urdf"] = "same_limits.urdf:8:5: a <limit>",
  ["urdf/unheard_of.urdf"] = "unheard_of.urdf:2:3: the element <planet>",
} do
  local ok, why = pcall(function() place:importScene(file) end)
  judge(file .. " is refused", not ok and tostring(why):find(message, 1, true) ~= nil)
end
judge("nothing is left behind", #place:children() == 0)
