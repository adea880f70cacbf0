-- row: 4
-- input: two links of 10 g on three damped, sprung and stopped hinges each, with bodies of 1e-9 kg m^2 between, fall
--   down
-- right: no hinge is beyond its stops, nothing is faster than its fall allows
-- engines: all
-- args: --duration 1.1
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.002)
get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false
local root = new("Transform", "/usr/scene/root")
root.localPos = { 0, 0, 1 }
root:new("RigidBody", "body"):setMassParameters(0.05, 0, 0, 0, 1e-5, 1e-5, 1e-5, 0, 0, 0)
root:new("SphereCollider", "ball").radius = 0.02
local hinges, place, before, last = {}, root, "../../body", nil
for i = 1, 2 do
  local spot = place:new("Transform", "link" .. i)
  spot.localPos = { 0.02, 0, 0 }
  for k, name in ipairs{ "x", "y", "z" } do
    local at = spot:new("Transform", name)
    local body = at:new("RigidBody", "body")
    if name == "z" then
      at.localPos = { 0.01, 0, 0 }
      body:setMassParameters(0.01, 0, 0, 0, 1e-6, 1e-6, 1e-6, 0, 0, 0)
      last = body
    else
      body:setMassParameters(1e-5, 0, 0, 0, 1e-9, 1e-9, 1e-9, 0, 0, 0)
      body.connector = true
    end
    local hinge = spot:new("HingeJoint", "hinge" .. k)
    hinge:attach("../" .. name .. "/body", before)
    hinge:setAnchor(0, 0, 0)
    hinge:setAxis(k - 1)
    hinge:setLowStopPos(0, -0.2)
    hinge:setHighStopPos(0, 0.2)
    hinge:setStopERP(0, 0.2)
    hinge:setSpring(0, 1, 0)
    hinge:setDamping(0, 0.02)
    hinges[#hinges + 1] = hinge
    before = "../" .. name .. "/body"
  end
  place, before = spot, "../../z/body"
end
local fastest = 0
on("sense", function()
  for _, v in ipairs(last.velocity) do fastest = math.max(fastest, math.abs(v)) end
end)
once(sim, 1, function()
  judge("the fastest is " .. fastest .. " m/s", fastest > 2 and fastest < 10)
  for i, hinge in ipairs(hinges) do near("the angle of hinge " .. i, math.rad(hinge:getAngle()), 0, 0.25) end
end)
