#!/usr/bin/env python3
# row: p95
# input: a rule reads properties of a mounted host that is stopped in the middle of a run, and goes on later
# right: the rule gets the last values at once, with their age; the link stays, and the values go on when the host does
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import freezes  # noqa: E402

SERVED = """
get("/sys/server/simulation").step = 0.01
local ball = new("Transform", "/usr/scene/ball")
local body = ball:new("RigidBody", "body")
body:setSphereTotal(1, 0.2)
get("/usr/scene/world").gravity = { 0, 0, 0 }
body.velocity = { 0.001, 0, 0 }
"""
MOUNTED = """
there.timeout = 60                                  -- s: a rule that waited would do so for that long
local ball, world, loop = there:find("ball"), there:find("world"), get("/sys/server/simulation")
loop.step, loop.rate = 0.01, "real"
local body, last, first = ball:find("body"), nil, nil
local stopped, mark, goesOn = false, nil, nil
on("rule", function(_, event)
  local x, vx, gravity = ball.localPos[1], body.velocity[1], world.gravity[3]
  if not stopped and event.cycle == 20 then
    first = x
    print("stop it")
    stopped = true
  elseif stopped and there.age > 1 and not mark then
    mark = { x = x, vx = vx }
    judge("the last place is there", x >= first)
    judge("the last speed is there", vx > 0)
    judge("the last value of what is no scene node is there", gravity == 0)
    judge("what was never read says why it is missing", not pcall(function() return world.erp end))
    judge("the link stays", there.connected)
    print("let it go on")
  elseif mark and there.age < 0.5 and x > mark.x and not goesOn then
    goesOn = true
    judge("the values go on", x > mark.x)
    loop:stop()
  end
end)
"""
freezes(SERVED, MOUNTED)
