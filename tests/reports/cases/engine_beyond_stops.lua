-- row: 4
-- input: an arm with three light fingers whose hinges start 0.8 to 1 rad beyond their stops
-- right: the hinges come back to their stops, no part is faster than 25 m/s, and every state is a number
-- engines: OdeEngine ArticulatedEngine BulletEngine
-- args: --duration 4.1
-- never: no number
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.005)
local bodies, hinges = {}, {}
--- A link of `mass` at the end of `place`, with a hinge about `axis` and stops [deg]; returns its end and path below
--- it.
local function link(place, second, mass, reach, inertia, axis, low, high)
  local tip, body = lightLink(place, "link", mass, reach, inertia)
  local hinge = lightHinge(place, "link", second)
  hinge:setAxis(axis)
  hinge:setLowStopDeg(0, low)
  hinge:setHighStopDeg(0, high)
  bodies[#bodies + 1], hinges[#hinges + 1] = body, { hinge = hinge, low = low, high = high }
  return tip
end
local place = new("Transform", "/usr/scene/base")
place = link(place, nil, 0.7, 0.1, 1e-3, 1, 50, 300)
place = link(place, "../../body", 0.9, 0.2, 5e-3, 1, 20, 340)
place = link(place, "../../body", 0.6, 0.1, 1e-3, 0, -180, 180)
place = link(place, "../../body", 0.4, 0.04, 3e-4, 1, 46, 300)
for i = 1, 3 do
  local root = place:new("Transform", "finger" .. i)
  root.localPos = { 0.05, 0.03 * (i - 2), 0 }
  local tip = link(root, "../../../body", 0.01, 0.022, 8e-7, 1, 10, 86)
  link(tip, "../../body", 0.01, 0.022, 8e-7, 1, 30, 115)
end
local fast = 0
on("sense", function(_, event)
  for _, b in ipairs(bodies) do
    local v = b.velocity
    for i = 1, 3 do fast = math.max(fast, math.abs(v[i])) end
  end
  if event.cycle ~= 800 then return end
  judge(string.format("the largest speed is %.3g m/s", fast), fast < 25)
  for i, h in ipairs(hinges) do
    local angle = h.hinge:getAngle()
    judge(string.format("hinge %d is at %.1f deg, between %g and %g", i, angle, h.low, h.high),
          angle > h.low - 6 and angle < h.high + 6)
  end
end)
