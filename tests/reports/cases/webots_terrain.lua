-- row: 7
-- input: a ball above the flat middle of an ElevationGrid with steep sides
-- right: it lies in the valley, not on a block that fills it; nothing is named
-- engines: all
-- args: --duration 1.6
-- never: is not supported
-- never: is left out
include "../lib/judge.lua"
include "../lib/webots.lua"
webotsCase()
judge("strict takes it", imports("webots/valley.wbt", true))
on("rule", function(_, event)
  if math.abs(event.time - 1.5) > 0.001 then return end
  near("the ball's height", get("/usr/scene/ball/ball/body").position[3], 0.7, 0.01)
end)
