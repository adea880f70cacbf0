-- row: 2
-- input: a force of 1e30 N on one of two bodies that a hinge joins
-- right: the log names the body that has no numbers, the pair falls on from where it was, and so does another crate
-- engines: all
-- args: --duration 1.1
-- expect: /usr/scene/upper/body
-- expect: was no number after the step
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
include "../lib/crate.lua"
local upper, place = crate("upper", 0, 5)
local _, other = crate("lower", 0, 4), crate("other", 9, 5)
local joint = place:new("HingeJoint", "joint")
joint:attach("../body", "../../lower/body")
joint:setAnchor(0, 0, -0.5)
joint:setAxis(1, 0, 0)
on("rule", function(_, event)
  if event.cycle == 5 then upper:addForce(1e30, 1e30, 1e30) end
end)
on("sense", function(_, event)
  if event.cycle ~= 50 then return end
  near("the height of the pair", upper.position[3], 1, 0.6)
  near("the height of the other crate", other.position[3], 0, 0.5)
end)
