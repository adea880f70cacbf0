-- Two crates that have come to rest on a shelf.
include "house.lua"

--- Builds the shelf, and changes the world at 4 s: "remove", "move" or "gravity".
function shelfCase(change)
  files() scene() physics(engineOption()) simulation()
  local shelf = new("Transform", "/usr/scene/space/shelf")
  shelf.localPos = { 0, 0, 2 }
  local board = shelf:new("BoxCollider", "board")
  board.boxLengths = { 2, 2, 0.1 }
  board:new("ContactJointHandler", "surface").contactBounceMode = false
  get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false
  local function crate(name, z)
    local place = new("Transform", "/usr/scene/space/" .. name)
    place.localPos = { 0, 0, z }
    local body = place:new("RigidBody", "body")
    body:setBoxTotal(1, 0.4, 0.4, 0.4)
    local box = place:new("BoxCollider", "box")
    box.boxLengths = { 0.4, 0.4, 0.4 }
    box:new("ContactJointHandler", "surface").contactBounceMode = false
    return body
  end
  local lower, upper = crate("lower", 2.26), crate("upper", 2.67)
  local function at(event, time) return math.abs(event.time - time) < 0.001 end
  on("rule", function(_, event)
    if at(event, 4) then
      near("the lower crate's height at rest", lower.position[3], 2.25, 0.02)
      if change == "remove" then shelf:delete() end
      if change == "move" then shelf.localPos = { 30, 0, 2 } end
      if change == "gravity" then get("/usr/scene/world").gravity = { 0, 0, 9.81 } end
    end
    if at(event, 6) then
      if change == "gravity" then judge("the upper crate has risen to " .. upper.position[3], upper.position[3] > 15)
      else
        near("the lower crate's height", lower.position[3], 0.2, 0.02)
        near("the upper crate's height", upper.position[3], 0.6, 0.02)
      end
    end
  end)
end
