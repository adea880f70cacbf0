-- row: 8
-- input: the crate with bad parts, in strict mode
-- right: it is refused, the error names each part with its place, and nothing is left behind
-- args: --duration 0.1
include "../lib/judge.lua"
include "house.lua"
files() scene() physics() simulation()
get("/sys/server/scene/mjcf").strict = true
local place = new("Transform", "/usr/scene/space/place")
local ok, why = pcall(function() place:importScene("mjcf_left_out.xml") end)
judge("the crate is refused", not ok)
for _, part in ipairs{ "12:7: <geom> 'top'", "17:7: <geom> 'thin'", "30:5: <exclude>", "33:5: <weld> 'glue'",
                       "39:5: <fixed> 'wire'", "42:5: <motor> 'lift'", "47:5: <gyro> 'spin'" } do
  judge("the error names " .. part, tostring(why):find("mjcf_left_out.xml:" .. part .. " is left out", 1, true) ~= nil)
end
judge("nothing is left behind", #place:children() == 0)
