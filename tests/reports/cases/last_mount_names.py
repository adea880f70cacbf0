#!/usr/bin/env python3
# row: p95
# input: a config renames a node that it has mounted, and uses it at once; and it mounts hosts that are not there
# right: the node has its new name and is read, set and called; errors say what is wrong, and nothing of the source code
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import *  # noqa: E402,F403
from programs import *  # noqa: E402,F403

SERVED = """
local ball = new("Transform", "/usr/scene/ball")
ball.localPos = { 3, 0, 1 }
"""
MOUNTED = """
local ball = there:find("ball")
ball.name = "globe"
judge("it has its new name", ball.name == "globe" and there:find("globe") ~= nil and not there:find("ball"))
ball.localPos = { 4, 0, 1 }
judge("it is set and read", ball.localPos[1] == 4)
ball:setLocalPos(5, 0, 1)
judge("it is called", ball.localPos[1] == 5)
local function refused(name, address, why)
  local ok, text = pcall(function() mount{ "/usr/" .. name, address = address, token = "a-token-of-some-length" } end)
  text = tostring(text)
  judge(address .. " is refused: " .. text, not ok and text:find(why, 1, true) and not text:find("boost", 1, true))
end
refused("closed", "127.0.0.1:1", "because: Connection refused")
refused("beyond", "127.0.0.1:68828", "expected a port of at most 65535, found '127.0.0.1:68828'")
"""
with Folder() as folder, Served(folder, SERVED) as served:
    mounted(folder, served, MOUNTED, "--duration", "0.01", "--set", "engine=OdeEngine")
watched = run("sparkwatch", "--port", "68828")
judge("sparkwatch refuses a port out of range", watched.returncode != 0 and "--port" in watched.stderr, watched.stderr)
watched = run("sparkwatch", "--messages", "-3")
judge("and fewer messages than none", watched.returncode != 0 and "--messages" in watched.stderr, watched.stderr)
