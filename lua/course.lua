-- A course for things that drive. A config calls
--
--     include "course.lua"
--     local a, b = course(12, 7, 4)       -- after physics(); half axes of its middle, and its width [m]
--
-- It is an ellipse around the origin, between two walls of white and red pieces.

-- A wall of n pieces along an ellipse.
local function wall(name, rx, ry, n)
  for i = 1, n do
    local t, u = 2 * math.pi * i / n, 2 * math.pi * (i + 1) / n
    local x, y = rx * math.cos(t), ry * math.sin(t)
    local dx, dy = rx * math.cos(u) - x, ry * math.sin(u) - y
    local piece = new("Transform", "/usr/scene/" .. name .. i)
    piece.localPos = { x + dx / 2, y + dy / 2, 0.25 }
    piece:setLocalRotation(0, 0, math.deg(math.atan(dy, dx)))
    local length = math.sqrt(dx * dx + dy * dy) + 0.1
    piece:new("BoxCollider", "box"):setBoxLengths(length, 0.1, 0.5)
    local shape = piece:new("Box", "shape")
    shape:setExtents(length, 0.1, 0.5)
    shape:setMaterial(i % 2 == 0 and "matWhite" or "matRed")
  end
end

--- Ground and walls of a course; returns its half axes.
function course(a, b, width)
  local ground = new("Transform", "/usr/scene/ground"):new("PlaneCollider", "plane")
  local tarmac = ground:new("ContactJointHandler", "surface")
  tarmac.contactPyramid, tarmac.contactMu, tarmac.contactBounceMode = true, 1.2, false
  wall("inner", a - width / 2, b - width / 2, 36)
  wall("outer", a + width / 2, b + width / 2, 48)
  return a, b
end
