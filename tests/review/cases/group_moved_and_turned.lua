-- Moving and turning a group moves its bodies and walls in the same cycle.
-- expect: cycle 1: body 1.0 0.0 1.0, wall 0.0 3.0 0.0
-- expect: cycle 2: body 11.0 2.0 1.0, wall 10.0 5.0 0.0
-- expect: cycle 4: body 10.0 3.0 1.0, wall 7.0 2.0 0.0
-- expect: the ball touches the moved wall
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene/world").gravity = { 0, 0, 0 }
local room = new("Transform", "/usr/scene/room")
room:new("Transform", "shelf").localPos = { 0, 0, 1 }
local chair = new("Transform", "/usr/scene/room/shelf/chair")
chair.localPos = { 1, 0, 0 }
chair:new("RigidBody", "body"):setBoxTotal(1, 0.2, 0.2, 0.2)
local wall = room:new("Transform", "wall")
wall.localPos = { 0, 3, 0 }
wall:new("BoxCollider", "static").boxLengths = { 1, 1, 1 }
local ball = new("Transform", "/usr/scene/ball")
ball.localPos = { 10, 5, 0 }
ball:new("RigidBody", "body"):setSphereTotal(1, 0.1)
ball:new("SphereCollider", "collider").radius = 0.1
local touched = ball:find("collider"):new("RecorderHandler", "recorder")
on("act", function(self, event)
  if event.cycle == 2 then room:setLocalPos(10, 2, 0) end
  if event.cycle == 4 then room:setLocalRotation(0, 0, 90) end
end)
on("rule", function(self, event)
  if event.cycle > 4 then return end
  local b, w = chair:find("body").position, wall.worldTransform
  local text = string.format("cycle %d: body %.1f %.1f %.1f, wall %.1f %.1f %.1f", event.cycle, b[1], b[2], b[3], w[13], w[14], w[15])
  print((text:gsub("%-0%.0", "0.0")))
  if event.cycle == 3 and #touched.colliders > 0 then print("the ball touches the moved wall") end
end)
