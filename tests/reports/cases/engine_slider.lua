-- row: 4
-- input: a plunger of 5 g in a tube of 10 g, with a spring of 20,000 N/m and a damping of 50 N s/m, in steps of 5 ms;
--   the tube turns freely
-- right: the plunger stays in the middle, and the tube turns on
-- engines: all
-- args: --duration 0.6
include "../lib/judge.lua"
include "../lib/light_link.lua"
local sim = lightWorld(0.005)
get("/usr/scene/world").gravity = { 0, 0, 0 }
local base = new("Transform", "/usr/scene/base")
local tube = base:new("RigidBody", "tube")
tube:setMassParameters(0.01, 0, 0, 0, 1e-5, 1e-5, 1e-5, 0, 0, 0)
local _, plunger = lightLink(base, "link", 0.005, 0.02, 1e-6)
local joint = base:new("SliderJoint", "slider")
joint:attach("../link/body", "../tube")
joint:setSpring(0, 20000, 0)
joint:setDamping(0, 50)
tube.angularVelocity, plunger.angularVelocity = { 0, 0, 3 }, { 0, 0, 3 }
once(sim, 0.5, function()
  near("the plunger's place", joint:getPosition(), 0, 0.001)
  judge("the tube turns on at " .. tube.angularVelocity[3] .. " rad/s",
        tube.angularVelocity[3] > 1 and tube.angularVelocity[3] < 4)
end)
