-- row: 4
-- input: hinges and sliders of 1e-6 to 1 kg m^2 and kg, with velocity controllers of 1e-3 to 1e3 N m s, weak and strong
--   ones, and springs of up to 1e5 N m, in steps of 20 ms
-- right: each has its speed, or moves with its bound, or rests where its spring does
-- engines: all
-- args: --duration 1.2
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.02)
local world = get "/usr/scene/world"
world.gravity, world.autoDisableFlag = { 0, 0, 0 }, false
local count, checks = 0, {}

--- A link that turns about its centre, or slides along x; its joint.
local function link(inertia, slides)
  count = count + 1
  local base = new("Transform", "/usr/scene/base" .. count)
  base.localPos = { 0, count, 0 }
  lightLink(base, "link", slides and inertia or 1, 0, slides and 1 or inertia)
  if not slides then return lightHinge(base, "link") end
  local joint = base:new("SliderJoint", "slider")
  joint:attach("../link/body", "")
  joint:setLocalAxis(0, 1, 0, 0)
  return joint
end

local function rate(joint, slides)
  if slides then return joint:getPositionRate() end
  return math.rad(joint:getAngleRate())
end

for _, slides in ipairs { false, true } do
  for _, inertia in ipairs { 1e-6, 1e-4, 1e-2, 1 } do
    for _, gain in ipairs { 1e-3, 1, 1e3 } do
      local kind = string.format("%s of %g with a gain of %g", slides and "slider" or "hinge", inertia, gain)
      local free = link(inertia, slides)
      free:setController(0, 0, gain, 0, 0.5, 0, 1e9)
      local weak = link(inertia, slides)
      weak:setController(0, 0, gain, 0, 0.5, 0, inertia * 0.1)
      local spring = link(inertia, slides)
      spring:setController(0, 100 * gain, gain, 0.1, 0, 0, 1e9)
      checks[#checks + 1] = function()
        -- 1 s: the time constant is inertia / gain.
        near("speed of a " .. kind, rate(free, slides), 0.5 * (1 - math.exp(-gain / inertia)), 0.011)
        local bounded = math.min(0.1, gain / inertia * 0.5)
        if bounded == 0.1 then near("speed of a weak " .. kind, rate(weak, slides), 0.1, 0.021) end
        judge("the spring of a " .. kind .. " has not gone mad", math.abs(rate(spring, slides)) < 1.2)
      end
    end
  end
end
once(sim, 1, function() for _, check in ipairs(checks) do check() end end)
