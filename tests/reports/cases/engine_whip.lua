-- row: 4
-- input: an arm of six links of 10 g swings freely into the stops of its hinges, where ODE's direct solver gives up
-- right: no part gets faster than 12 m/s, and every state is a number
-- engines: OdeEngine ArticulatedEngine BulletEngine
-- args: --duration 4.1
-- never: no number
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.005)
local place, second, bodies = new("Transform", "/usr/scene/base"), nil, {}
-- Where each hinge is in the link before, its axis and its stop [deg].
local hinges = { { 0, 0, 0.25, 2, 180 }, { 0, 0, 0, 1, 180 }, { 0, 0, 0.7, 1, 270 },
                 { 0, 0, 0, 0, 190 }, { 0.55, -0.15, 0, 1, 180 }, { 0.15, 0, 0, 0, 190 } }
for i, h in ipairs(hinges) do
  place = place:new("Transform", "at")
  place.localPos = { h[1], h[2], h[3] }
  local _, body = lightLink(place, "link", 0.01, 0, 3.5e-5)
  bodies[i] = body
  local hinge = lightHinge(place, "link", second)
  hinge:setAxis(h[4])
  hinge:setLowStopDeg(0, -h[5])
  hinge:setHighStopDeg(0, h[5])
  second = "../../link/body"
end
local fast = 0
on("sense", function(_, event)
  for _, b in ipairs(bodies) do
    local v = b.velocity
    for i = 1, 3 do fast = math.max(fast, math.abs(v[i])) end
  end
  if event.cycle == 800 then judge(string.format("the largest speed is %.3g m/s", fast), fast < 12) end
end)
