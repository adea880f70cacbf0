-- Two crates that have come to rest on a shelf.
include "house.lua"

local function dull(collider) collider:new("ContactJointHandler", "surface").contactBounceMode = false end

--- Calls `what` at `time` [s], in the phase "rule".
function at(time, what)
  on("rule", function(_, event) if math.abs(event.time - time) < 0.001 then what(event) end end)
end

--- A crate of 1 kg and 0.4 m at a place.
function crateAt(name, place)
  local node = new("Transform", "/usr/scene/space/" .. name)
  node.localPos = place
  local body = node:new("RigidBody", "body")
  body:setBoxTotal(1, 0.4, 0.4, 0.4)
  local box = node:new("BoxCollider", "box")
  box.boxLengths = { 0.4, 0.4, 0.4 }
  dull(box)
  return body
end

--- A ground at z = 0.
function flatGround() dull(get("/usr/scene/space"):new("PlaneCollider", "ground")) end

--- Builds a shelf of 2 m with two crates; returns shelf, lower crate, upper crate.
function shelf()
  files() scene() physics(engineOption()) simulation()
  local place = new("Transform", "/usr/scene/space/shelf")
  place.localPos = { 0.9, 0, 2 }
  local board = place:new("BoxCollider", "board")
  board.boxLengths = { 2, 2, 0.1 }
  dull(board)
  flatGround()
  return place, crateAt("lower", { 0, 0, 2.26 }), crateAt("upper", { 0, 0, 2.67 })
end

--- At 4 s, when the crates rest, calls change(shelf, lower, upper); after 6 s expects them at these heights [m], on the
--- ground if none are given.
function shelfCase(change, lowerHeight, upperHeight)
  local place, lower, upper = shelf()
  at(4, function()
    near("the lower crate's height at rest", lower.position[3], 2.25, 0.02)
    change(place, lower, upper)
  end)
  at(6, function()
    near("the lower crate's height", lower.position[3], lowerHeight or 0.2, 0.03)
    near("the upper crate's height", upper.position[3], upperHeight or 0.6, 0.03)
  end)
end
