-- row: 1
-- input: a transform is moved after the body below it was made, and then a joint is attached: to the world, and to
--    another body
-- right: the joint holds the body where the transform is; nothing jumps
-- engines: all
-- args: --duration 0.6
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
get("/usr/scene/world").gravity = { 0, 0, 0 }
local function crate(name, y, above)
  local place = (above or get "/usr/scene"):new("Transform", name)
  if not above then place.localPos = { 0, y, 2 } end
  local body = place:new("RigidBody", "body")
  body:setBoxTotal(2, 0.3, 0.3, 0.3)
  return place, body
end
local door, doorBody = crate("door", 0)
door.localPos = { 4, 0, 2 }
door:setLocalRotation(0, 0, 90)
local hinge = door:new("HingeJoint", "hinge")
hinge:attach("../body", "")
hinge:setAnchor(-0.5, 0, 0)
hinge:setAxis(0, 0, 1)

local cart = new("Transform", "/usr/scene/cart")
local base, baseBody = crate("base", 5, cart)
local arm, armBody = crate("arm", 5, cart)
arm.localPos = { 0.5, 0, 0 }
cart.localPos = { -3, 5, 1 }
local link = arm:new("FixedJoint", "link")
link:attach("../body", "../../base/body")
local fast = 0
on("rule", function(_, event)
  for _, b in ipairs{ doorBody, baseBody, armBody } do
    local v = b.velocity
    fast = math.max(fast, math.sqrt(v[1]^2 + v[2]^2 + v[3]^2))
  end
  if math.abs(event.time - 0.5) > 0.001 then return end
  for what, of in pairs{ door = { doorBody, 4, 0, 2 }, base = { baseBody, -3, 5, 1 }, arm = { armBody, -2.5, 5, 1 } } do
    local p = of[1].position
    local apart = math.abs(p[1] - of[2]) + math.abs(p[2] - of[3]) + math.abs(p[3] - of[4])
    near("how far the " .. what .. " is from its place", apart, 0, 1e-3)
  end
  judge("the greatest speed was " .. fast, fast < 1e-3)
end)
