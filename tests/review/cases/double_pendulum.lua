-- A config alone builds a double pendulum and lets it swing.
-- expect: both hinges hold, to 2 mm
-- expect: it swings and keeps its energy, to 1 %
-- args: --rate max --duration 4
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene/world").timestep = 0.002

-- Two rods of 1 kg and 1 m, one below the other, thrown from the horizontal.
local length = 1
local function rod(name, x)
  local place = new("Transform", "/usr/scene/" .. name)
  place.localPos = { x, 0, 5 }
  place:new("RigidBody", "body"):setBoxTotal(1, length, 0.05, 0.05)
  return place
end
local upper, lower = rod("upper", 0.5 * length), rod("lower", 1.5 * length)

local function hinge(place, other)
  local joint = place:new("HingeJoint", "hinge")
  joint:attach("../body", other)
  joint:setAnchor(-0.5 * length, 0, 0)
  joint:setAxis(0, 1, 0)
  return joint
end
hinge(upper, "")
hinge(lower, "../../upper/body")

-- The end of a rod: half a length from its centre along its x axis.
local function tip(place, side)
  local m = place.localTransform
  return { m[13] + side * 0.5 * length * m[1], m[15] + side * 0.5 * length * m[3] }
end
local function apart(a, b) return math.abs(a[1] - b[1]) + math.abs(a[2] - b[2]) end
local function energy(place)
  local body = place:find("body")
  local v, w = body.velocity, body.angularVelocity
  return 9.81 * body.position[3] + (v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2) / 2 + (length ^ 2 + 0.05 ^ 2) / 12 * w[2] ^ 2 / 2
end

local gap, deepest, begin = 0, 5, 0
on("rule", function(self, event)
  if event.cycle == 1 then begin = energy(upper) + energy(lower) end
  gap = math.max(gap, apart(tip(upper, -1), { 0, 5 }), apart(tip(upper, 1), tip(lower, -1)))
  deepest = math.min(deepest, lower:find("body").position[3])
  if event.cycle ~= 190 then return end
  local now = energy(upper) + energy(lower)
  if gap < 2e-3 then print("both hinges hold, to 2 mm") end
  if deepest < 3.6 and math.abs(now - begin) < 0.01 * begin then print("it swings and keeps its energy, to 1 %") end
  log.debug("gap", gap, "deepest", deepest, "energy", begin, now)
end)
