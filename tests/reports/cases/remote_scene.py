#!/usr/bin/env python3
# row: p95
# input: a host mounts the scene of another one below a room of its own, turned and far away
# right: what is there has transforms that follow the room; eyes, rays and viewers see it, bodies rest on it, sets and calls go to the other host
# engines: all
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import *  # noqa: E402,F403
from programs import *  # noqa: E402,F403

SERVED = """
local ball = new("Transform", "/usr/scene/ball")
ball.localPos = { 3, 0, 1 }
local look = ball:new("Sphere", "look")
look.radius = 0.5
look:setMaterial("matRed")
ball:new("SphereCollider", "shape").radius = 0.5
local table = ball:new("Transform", "table")          -- turns and moves with the ball
table.localPos = { 0, 4, 0 }
table:new("BoxCollider", "top"):setBoxLengths(2, 2, 0.2)
local fan = table:new("Transform", "fan")
fan:new("Box", "blade"):setExtents(1, 0.1, 0.1)
new("PlaneCollider", "/usr/scene/ground")
local drop = new("Transform", "/usr/scene/drop")
drop.localPos = { 0, 0, 50 }
drop:new("RigidBody", "body"):setSphereTotal(1, 0.2)
"""
MOUNTED = """
local physics, loop = get("/sys/server/physics"), get("/sys/server/simulation")
local ball = there:find("ball")
judge("it is a transform", ball:isA("Transform") and ball.class == "Transform@there")
judge("its look is a sphere", ball:find("look"):isA("Sphere") and ball:find("look").materials[1] == "matRed")
judge("a body of the other host is none here", not there:find("drop/body"):isA("RigidBody"))
local function place(what, x, y, z)
  local m = ball.worldTransform
  near(what .. ": x", m[13], x, 1e-4) near(what .. ": y", m[14], y, 1e-4) near(what .. ": z", m[15], z, 1e-4)
end
local function ray(what, from, direction, distance, node)
  local hit = physics:castRay(from, direction, 20)
  judge(what .. ": the ray meets " .. node, hit and hit[2] == node)
  if hit then near(what .. ": the ray", hit[1], distance, 1e-4) end
end
loop:runCycles(1)
place("mounted", 100, 3, 1)
ray("mounted", { 100, 0, 1 }, { 0, 1, 0 }, 2.5, "/usr/scene/room/there/ball/shape")
ray("mounted", { 96, 3, 5 }, { 0, 0, -1 }, 3.9, "/usr/scene/room/there/ball/table/top")
judge("no plane of the other host is here", not physics:castRay({ 0, 0, 1 }, { 0, 0, -1 }, 20))

ball.localPos = { 5, 0, 1 }
judge("a set counts at once", ball.localPos[1] == 5)
loop:runCycles(1)
place("set there", 100, 5, 1)
ray("set there", { 100, 0, 1 }, { 0, 1, 0 }, 4.5, "/usr/scene/room/there/ball/shape")
ball:find("shape").radius = 1
ball:find("look").radius = 1
loop:runCycles(1)
ray("grown there", { 100, 0, 1 }, { 0, 1, 0 }, 4, "/usr/scene/room/there/ball/shape")
judge("the look has grown", ball:find("look").scale[1] == 1)
ball:setLocalPos(3, 0, 1)
loop:runCycles(1)
place("called there", 100, 3, 1)
ball:setLocalRotation(0, 0, 90)
loop:runCycles(1)
ray("turned there", { 100, -1, 5 }, { 0, 0, -1 }, 3.9, "/usr/scene/room/there/ball/table/top")

room.localPos = { 100, 0, 10 }
loop:runCycles(1)
place("the room has moved", 100, 3, 11)
ray("the room has moved", { 100, -1, 15 }, { 0, 0, -1 }, 3.9, "/usr/scene/room/there/ball/table/top")

local own = new("Transform", "/usr/scene/own")
own.localPos = { 100, -1, 11.5 }
own:new("RigidBody", "body"):setSphereTotal(1, 0.2)
own:new("SphereCollider", "shape").radius = 0.2
own:find("shape"):new("ContactJointHandler", "handler")
loop:runCycles(100)
near("a body rests on the table", own.localPos[3], 11.3, 0.02)

local seen = {}
local eye = new("Transform", "/usr/scene/eye"):new("AgentAspect", "agent")
eye:new("PerfectVisionPerceptor", "vision")
eye:new("ScriptBehavior", "mind"):on("think", function(self, e)
  for _, percept in ipairs(e.data) do
    if percept[1] == "PerfectVision" then
      for i = 2, #percept do seen[percept[i][1]] = percept[i][2] end
    end
  end
end)
loop:runCycles(5)
judge("the eye sees the ball", seen.ball ~= nil and seen.fan ~= nil)
if seen.ball then near("the eye sees it at z", seen.ball[4], 11, 1e-4) end
"""
with Folder() as folder, Served(folder, SERVED) as served:
    mounted(folder, served, MOUNTED, "--duration", "0.01", "--set", f"engine={sys.argv[1]}")
