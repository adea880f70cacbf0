-- row: 7
-- input: a tray that moves, a mesh with a hollow
-- right: it collides as its convex hull, which the log says
-- engines: all
-- args: --duration 1
-- expect: a <collision> that moves and is not convex collides as its convex hull
include "../lib/judge.lua"
include "../lib/mesh.lua"
local space = meshWorld()
space:new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false
local place = new("Transform", "/usr/scene/place")
place.localPos = { 0, 0, 0.05 }
place:importScene("mesh_moving_tray.urdf")
local body = get("/usr/scene/place/moving/tray/body")
atTime(0.9, function() judge("it lies on the ground, at " .. body.position[3], math.abs(body.position[3]) < 0.02) end)
