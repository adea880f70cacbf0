-- row: 2
-- input: a universal joint is turned until its axes are parallel, which ODE takes for an error of its own code
-- right: the error and the bodies of the joint are named, the other crate falls on
-- engines: OdeEngine
-- args: --duration 1.1
-- expect: ODE failed: assertion
-- expect: /usr/scene/upper/body
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
include "../lib/crate.lua"
local upper, place = crate("upper", 0, 5)
local lower, other = crate("lower", 0, 4), crate("other", 9, 5)
local joint = place:new("UniversalJoint", "joint")
joint:attach("../body", "../../lower/body")
joint:setAnchor(0, 0, -0.5)
joint:setAxis1(1, 0, 0)
joint:setAxis2(0, 1, 0)
on("rule", function(_, event)
  if event.cycle == 10 then lower:setLocalPose(0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0) end
end)
on("sense", function(_, event)
  if event.cycle == 50 then near("the height of the other crate", other.position[3], 0, 0.1) end
end)
