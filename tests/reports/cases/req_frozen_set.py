#!/usr/bin/env python3
# row: p95
# input: a rule sets and calls nodes of a mounted host that is stopped, listens there, and goes on when the host does
# right: each is refused at once, the error says since when, nothing of it happens later, and the link stays
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import freezes  # noqa: E402

SERVED = """
get("/sys/server/simulation").step = 0.01
local ball = new("Transform", "/usr/scene/ball")
ball.localPos = { 1, 2, 3 }
"""
MOUNTED = """
there.timeout = 2                                   -- s: one that waited would lose the link
local ball, loop = there:find("ball"), get("/sys/server/simulation")
loop.step, loop.rate = 0.01, "real"
local stopped, refused, done
local function why(f) local good, text = pcall(f) return not good and text:match("has been frozen for %d") end
on("rule", function(_, event)
  if not stopped and event.cycle == 20 then
    ball.localPos = { 2, 2, 3 }
    print("stop it")
    stopped = true
  elseif stopped and not refused and there.age > 1.2 then
    refused = true
    for i = 1, 3 do
      judge("set is refused", why(function() ball.localPos = { 9, 9, 9 } end))
      judge("call is refused", why(function() ball:setLocalPos(8, 8, 8) end))
      judge("listening is refused", why(function() ball:on("rule", function() end) end))
    end
    judge("the link stays", there.connected)
    print("let it go on")
  elseif refused and there.age < 0.3 and not done then
    done = true
    judge("what was refused has not happened: " .. ball.localPos[1], ball.localPos[1] == 2)
    ball.localPos = { 3, 2, 3 }
    judge("what is set now happens: " .. ball.localPos[1], there.connected)
    loop:stop()
  end
end)
"""
freezes(SERVED, MOUNTED)
