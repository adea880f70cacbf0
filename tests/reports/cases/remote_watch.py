#!/usr/bin/env python3
# row: p95
# input: a camera, a distance sensor and a monitor of a host that has mounted the scene of another one
# right: all of them see what is there, and see it move
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from client import Client  # noqa: E402
from mounts import *  # noqa: E402,F403
from programs import *  # noqa: E402,F403

SERVED = """
local crate = new("Transform", "/usr/scene/crate")
crate.localPos = { 3, 0, 1 }
local look = crate:new("Box", "look")
look:setExtents(1, 1, 1)
look:setMaterial("matRed")
crate:new("BoxCollider", "shape"):setBoxLengths(1, 1, 1)
"""
# The room is turned: the crate is 3 m ahead of its middle, along y.
MOUNTED = """
camera()
monitors{ port = 0 }
local loop, crate = get("/sys/server/simulation"), there:find("crate")
local eye = new("Transform", "/usr/scene/eye")
eye.localPos = { 100, 0, 1 }
local agent = eye:new("AgentAspect", "agent")
local pictures = agent:new("ImagePerceptor", "pictures")
pictures.width, pictures.height, pictures.picture = 8, 8, "depth"
agent:new("DistancePerceptor", "distance")
local seen = {}
agent:new("ScriptBehavior", "mind"):on("think", function(_, event)
  for _, percept in ipairs(event.data) do seen[percept[1]] = percept end
end)
local function image() return seen.IMG and seen.IMG[#seen.IMG][2] end
local function distance() return seen.DST and seen.DST[#seen.DST][2] end
loop:runCycles(4)
local before = image()
judge("there are pictures and a distance", before ~= nil and distance() ~= nil)
near("the distance", distance() or -1, 2.5, 0.01)
crate.localPos = { 4, 0, 1 }
loop:runCycles(4)
judge("the picture is another one", image() ~= before)
near("the distance when it is farther", distance() or -1, 3.5, 0.01)
local far = image()
crate.localPos = { 40, 0, 1 }
loop:runCycles(4)
judge("the picture is empty", image() ~= far and image():match("^A+=*$") ~= nil)
near("the distance to nothing", distance() or -1, 10, 0.01)
crate.localPos = { 3, 0, 1 }
loop.rate = "real"
"""
with (Folder() as folder, Served(folder, SERVED) as served,
      Mounted(folder, served, MOUNTED, "--duration", "60") as mounted):
    for line in mounted.lines():
        if "Port monitors" in line:
            port = int(line.split(":")[-1].strip().rstrip("."))
        if "right: the end" in line:
            text = Client(port).receive()
            judge("the monitor gets the crate", "StdUnitBox" in text and "matRed" in text, text)
            judge("it gets it in the room", " 100 0 0 1)" in text and " 3 0 1 1)" in text, text)
            mounted.process.terminate()
