-- An engine that cannot step single islands has no effect below the articulated engine, which says so once.
-- expect: warning /sys/server/physics/engine: /sys/server/physics/engine/deferred cannot step single islands; it has no effect here
-- expect: moved down by a
-- expect: "faults":0
-- args: --rate max --duration 0.2
include "house.lua"
files() scene() physics("ArticulatedEngine") simulation()
plugin "physics-mujoco"
local engine = get("/sys/server/physics/engine")
engine:find("deferred"):delete()
engine:new("MujocoEngine", "deferred")
local ball = get("/usr/scene"):new("Transform", "ball")
ball:new("RigidBody", "body"):setMass(1)
on("act", function(self, event)
  if event.cycle == 9 then print(ball.localPos[3] < -0.05 and "moved down by a free fall" or "did not move") end
end)
