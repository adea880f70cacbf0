#!/usr/bin/env python3
# row: p95
# input: a run is recorded that reads, sets and calls nodes of a mounted host, handles its events, connects anew, and loses it
# right: it is simulated again without that host, to the same state, and nothing is connected to
import signal
import socket
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import *  # noqa: E402,F403
from programs import *  # noqa: E402,F403

SERVED = """
get("/sys/server/simulation").step = 0.01
local ball = new("Transform", "/usr/scene/ball")
ball.localPos = { 1, 0, 40 }
ball:new("RigidBody", "body"):setSphereTotal(1, 0.2)
ball:new("SphereCollider", "shape").radius = 0.2
local wall = new("Transform", "/usr/scene/wall")
wall.localPos = { 0, 0, 4 }
wall:new("BoxCollider", "shape"):setBoxLengths(4, 4, 1)
"""
MOUNTED = """
local ball, body, world = there:find("ball"), there:find("ball/body"), there:find("world")
local loop = get("/sys/server/simulation")
loop.step = 0.01
judge("a value is there while the config runs", body.velocity[3] <= 0 and ball.localPos[1] == 1)
local own = new("Transform", "/usr/scene/own")
own.localPos = { 100, 0, 6 }
local mover = own:new("RigidBody", "body")
mover:setSphereTotal(1, 0.2)
own:new("SphereCollider", "shape").radius = 0.2
local heard, lost = 0, false
ball:on("rule", function(_, event)
  heard = heard + 1
  mover:addForce(0.01 * ball.localPos[3], 0, 0)
  if heard == 5 then body:setVelocity(0, 0, 1) end
end)
there:on("remoteLost", function() lost = true mover.velocity = { 0, 0, 2 } end)
on("rule", function(_, event)
  mover:addForce(0, 0.1 * body.velocity[3], 0)
  if event.cycle == 10 then mover:addForce(world.gravity[3], 0, 0) end        -- asked in a cycle
  if event.cycle == 20 then ball.localPos = { 2, 0, 30 } end
  if event.cycle == 25 then
    there:close()
    there:connect("")
    ball, body = there:find("ball"), there:find("ball/body")
    mover:addForce(0, body.velocity[3] + ball.localPos[3], 0)
  end
  if event.cycle == 40 then print("kill it") end
  if lost and event.cycle > 60 then loop:stop() end
end)
"""
with Folder() as folder, Served(folder, SERVED) as served:
    with Mounted(folder, served, MOUNTED, "--duration", "60", "--record", "run.mcap", cwd=folder) as mounted:
        for line in mounted.lines():
            if "kill it" in line:
                served.process.send_signal(signal.SIGKILL)
                served.process.wait()
                served.address.unlink()
                listener = socket.socket(socket.AF_UNIX)
                listener.bind(str(served.address))
                listener.listen()
    code, again, log = verify(folder / "run.mcap")
    same = code == 0 and again.get("differs", "") is None and again["cycles"] > 60
    judge("it is the same without the other host", same, f"{code} {again} {log}")
    listener.setblocking(False)
    try:
        listener.accept()
        judge("nothing is connected to", False)
    except BlockingIOError:
        judge("nothing is connected to", True)
