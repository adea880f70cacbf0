-- A body of the mass [kg] (1), with the moments of a box of 0.4 m and no shape. Returns it and its place.
function crate(name, x, z, mass)
  local place = new("Transform", "/usr/scene/" .. name)
  place.localPos = { x, 0, z }
  local body = place:new("RigidBody", "body")
  body:setBoxTotal(mass or 1, 0.4, 0.4, 0.4)
  return body, place
end
