-- Balls that are put onto meshes.
include "house.lua"

--- A world with importers, and air and contacts as usual.
function meshWorld()
  files() scene() physics(engineOption()) simulation()
  return get "/usr/scene/space"
end

--- A ball of 1 kg; returns its body.
function ball(name, radius, x, y, z)
  local place = new("Transform", "/usr/scene/space/" .. name)
  place.localPos = { x, y, z }
  local body = place:new("RigidBody", "body")
  body:setSphereTotal(1, radius)
  local sphere = place:new("SphereCollider", "sphere")
  sphere.radius = radius
  sphere:new("ContactJointHandler", "surface").contactBounceMode = false
  return body
end

--- Calls `check` at that time.
function atTime(time, check)
  on("rule", function(_, event) if math.abs(event.time - time) < 0.001 then check() end end)
end
