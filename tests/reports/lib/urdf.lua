-- A robot of a file above the ground.
include "house.lua"

--- Builds the world and imports the file at a height; returns its first node.
function urdfRobot(file, height)
  files() scene() physics(engineOption()) simulation()
  get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false
  local place = new("Transform", "/usr/scene/space/place")
  place.localPos = { 0, 0, height }
  place:importScene(file)
  return place:children()[1]
end

--- Says at a time whether something is near what is expected.
function nearAt(time, what, seen, expected, tolerance)
  on("rule", function(_, event)
    if math.abs(event.time - time) < 0.001 then near(what, seen(), expected, tolerance) end
  end)
end
