#!/usr/bin/env python3
# row: p95
# input: a host without physics, and one whose scene has no world, mount a scene with colliders
# right: one line in the log for each class that cannot be in the scene; looks and transforms are there, and the nodes can be read and set
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import *  # noqa: E402,F403
from programs import *  # noqa: E402,F403

SERVED = """
for i = 1, 3 do
  local crate = new("Transform", "/usr/scene/crate" .. i)
  crate.localPos = { i, 0, 0 }
  crate:new("BoxCollider", "shape"):setBoxLengths(i, 1, 1)
  crate:new("Box", "look"):setExtents(i, 1, 1)
end
"""
MOUNTS = """
include "house.lua"
include "materials.lua"
files() scene() materials() simulation() %s
local there = mount{ "/usr/scene/there", address = "%s", of = "/usr/scene" }
local function judge(what, good) print((good and "right: " or "wrong: ") .. what) end
local shape = there:find("crate3/shape")
judge("the transform is one", there:find("crate3"):isA("Transform") and there:find("crate3").localPos[1] == 3)
judge("the look is a box", there:find("crate3/look"):isA("Box"))
judge("the collider is a node of the other host", not shape:isA("Collider") and shape:isA("RemoteNode"))
judge("it is read there", there:find("crate2/shape").boxLengths[1] == 2)
shape.boxLengths = { 5, 1, 1 }
judge("it is set there", shape.boxLengths[1] == 5)
"""
with Folder() as folder, Served(folder, SERVED) as served:
    for what, more, text in (("no physics", "", 'no plugin here has it. Add plugin "physics"'),
                             ("no world", 'plugin "physics"', "expected a World in its scene")):
        (folder / "mounts.lua").write_text(MOUNTS % (more, served.address))
        done = host("--config", folder / "mounts.lua", "--log-level", "info", "--duration", "0.1", cwd=folder)
        for line in done.stderr.splitlines():
            if "right: " in line or "wrong: " in line:
                print(line[line.index("right: " if "right: " in line else "wrong: "):])
        judge(f"{what}: it runs", done.returncode == 0, done.stderr)
        judge(f"{what}: one line says so", done.stderr.count(text) == 1, done.stderr)
