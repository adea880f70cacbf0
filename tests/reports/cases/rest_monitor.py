# row: p18
# input: sparkwatch, the monitor on libspark, follows a host with a falling ball and things that stay
# right: it prints where they are, in its own tree, from full messages and differences
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
from client import Host, judge  # noqa: E402

CONFIG = """
include "house.lua"
files() scene() physics() simulation() agents{} monitors{} web()
local function thing(name, mesh, place)
  local node = new("Transform", "/usr/scene/" .. name)
  node.localPos = place
  node:new("SingleMatNode", "look"):load(mesh)
  return node
end
local ball = thing("ball", "StdUnitSphere", { 1, 2, 50 })
ball:new("RigidBody", "body"):setSphereTotal(1, 0.1)
thing("post", "StdUnitBox", { -3, 0.5, 1 })
local part = new("Transform", "/usr/scene/post/part")
part.localPos = { 0, 0, 2 }
part:new("SingleMatNode", "look"):load("StdUnitCylinder")
"""


def watch(port, *arguments):
    ended = subprocess.run([os.environ["SPARKBIN"] + "/sparkwatch", "--port", str(port), *arguments],
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return [json.loads(line) for line in ended.stdout.splitlines()], ended


with tempfile.TemporaryDirectory() as folder:
    config = Path(folder) / "config.lua"
    config.write_text(CONFIG)
    with Host("--config", str(config)) as host:
        port = host.ports["monitorPort"]
        seen, _ = watch(port, "--messages", "8")
        balls = [s for s in seen if s["mesh"] == "StdUnitSphere"]
        judge("eight messages, three meshes in each", len(balls) == 8 and len(seen) == 24)
        # The engine's steps: z = 50 - g t (t + h) / 2 with h between 0 and a cycle.
        first, last = balls[0], balls[-1]
        late = [50 - 9.81 / 2 * b["time"] ** 2 - b["position"][2] for b in balls]
        falls = all(-1e-3 <= d <= 9.81 / 2 * b["time"] * 0.021 for d, b in zip(late, balls))
        judge(f"the ball falls: {first['position']} at {first['time']}, {last['position']} at {last['time']}",
              falls and first["position"][2] > last["position"][2])
        judge("what is still stays", all(s["position"] == [-3, 0.5, 1] for s in seen if s["mesh"] == "StdUnitBox"))
        judge("a part is where its parent is",
              all(s["position"] == [-3, 0.5, 3] for s in seen if s["mesh"] == "StdUnitCylinder"))
        only, _ = watch(port, "--mesh", "Cyl", "--messages", "1")
        judge("one mesh is asked for", [s["mesh"] for s in only] == ["StdUnitCylinder"])
        _, none = watch(port, "--mesh", "teapot", "--messages", "1")
        judge("none: an error",
              none.returncode == 1 and "no visible mesh has a name that contains 'teapot'" in none.stderr)
