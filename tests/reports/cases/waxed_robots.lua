-- row: 12
-- input: robots whose files say that they slide with a friction of 0.2, on a ground of the config without a surface
-- right: the robot's friction counts, with each engine: at 1 m/s it slides 0.255 m
-- engines: all
-- args: --duration 1.2
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld():new("PlaneCollider", "ground")
local bodies = {}
for i, file in ipairs { "waxed.urdf", "waxed_contact.urdf", "waxed.xml" } do
  local place = new("Transform", "/usr/scene/robot" .. i)
  place.localPos = { 0, 2 * i, 0.05 }
  place:importScene(file)
  bodies[file] = place:children()[1]:find "trunk/body"
  bodies[file].velocity = { 1, 0, 0 }
end
atTime(1.1, function()
  for file, body in pairs(bodies) do near("the way of " .. file, body.position[1], 0.5 / (0.2 * 9.81), 0.02) end
end)
