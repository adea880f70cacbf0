-- row: N3
-- input: four hundred bodies in one place
-- right: the steps end, and nothing flies away as not a number
-- args: --duration 0.04
include "house.lua"
include "../../reports/lib/judge.lua"
files() scene() physics() simulation()
local space, bodies = get "/usr/scene/space", {}
for i = 1, 400 do
  local place = space:new("Transform", "t" .. i)
  bodies[i] = place:new("RigidBody", "body")
  bodies[i]:setSphereTotal(1, 0.1)
  local collider = place:new("SphereCollider", "collider")
  collider.radius = 0.1
  collider:new("ContactJointHandler", "surface")
end
on("rule", function(_, event)
  if event.cycle ~= 2 then return end
  local most = 0
  for _, body in ipairs(bodies) do
    for _, x in ipairs(body.position) do most = math.max(most, x == x and math.abs(x) or math.huge) end
  end
  judge(("after two cycles all are within %g m"):format(most), most < 100)
end)
