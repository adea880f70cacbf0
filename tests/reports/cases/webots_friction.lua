-- row: 12
-- input: a waxed block and one with a tyre on a ramp of 0.7 rad; contactProperties give them friction of 0.2 and 1.5
-- right: the waxed one slides with 4.82 m/s^2, the other one stays
-- engines: all
-- args: --duration 1.1
include "../lib/judge.lua"
include "../lib/webots.lua"
webotsCase()
judge("strict takes it", imports("webots/slide.wbt", true))
local function along(name)                      -- down the ramp [m]
  local p = get("/usr/scene/" .. name .. "/" .. name .. "/body").position
  return -math.cos(0.7) * (p[2] + 0.4525) - math.sin(0.7) * (p[3] - 0.537)
end
local first
on("rule", function(_, event)
  if math.abs(event.time - 0.2) < 0.001 then first = { along "waxed", along "tyred" } end
  if math.abs(event.time - 1) < 0.001 then
    near("the way of the waxed one", along "waxed" - first[1], 0.5 * 4.819 * (1 - 0.2 ^ 2), 0.1)
    near("the way of the other one", along "tyred" - first[2], 0, 0.01)
  end
end)
