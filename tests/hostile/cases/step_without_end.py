#!/usr/bin/env python3
# row: N3
# input: sixty bodies in one place with the direct solver, whose first step takes a minute; the host is asked to end
# right: it ends soon
# slow: yes
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import host, judge  # noqa: E402

CONFIG = """include "house.lua"
files() scene() physics() simulation()
get("/sys/server/physics/engine").directRows = 1000000
local space = get "/usr/scene/space"
for i = 1, 60 do
  local place = space:new("Transform", "t" .. i)
  place:new("RigidBody", "body"):setSphereTotal(1, 0.1)
  local collider = place:new("SphereCollider", "collider")
  collider.radius = 0.1
  collider:new("ContactJointHandler", "surface")
end
"""


def main():
    with host("--rate", "max", "--duration", "1", "--set", "/sys/host/watchdog.after=0.5",
              "--set", "/sys/host/watchdog.giveUp=1", config=CONFIG) as h:
        judge(h.wait_for("stands still") is not None, "the log says that a step takes long")
        h.process.terminate()
        code = h.process.wait()
        h.reader.join()
        judge(code == -15 and "ends without the end of this cycle" in h.text(), f"it ends, exit code {code}")


main()
