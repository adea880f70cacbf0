-- An axis that is set before (attach ...) takes effect.
-- expect: axis 0 1 0, anchor 0 0 1
-- expect: turned by 90 deg
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene/world").gravity = { 0, 0, 0 }
get("/usr/scene"):importScene("rsg/review/axis_first.rsg")
local joint = get("/usr/scene/wheel/joint")
local function text(v) return string.format("%.0f %.0f %.0f", v[1] + 0.0, v[2] + 0.0, v[3] + 0.0):gsub("%-0", "0") end
print("axis " .. text(joint:getAxis()) .. ", anchor " .. text(joint:getAnchor()))
on("rule", function(self, event)
  if event.cycle == 50 then print(string.format("turned by %.0f deg", joint:getAngle())) end
end)
