#!/usr/bin/env python3
# row: 7
# input: SIGTERM while a config makes the hull of a million points
# right: the host ends, before the hull is made
import os
import signal
import subprocess
import tempfile
from pathlib import Path

CONFIG = """
include "house.lua"
files() scene() physics() simulation()
local corners = {}
for i = 1, 1000000 do
  local z, turn = 1 - (2 * i - 1) / 1000000, 2.39996323 * i
  local r = math.sqrt(1 - z * z)
  corners[#corners + 1] = r * math.cos(turn)
  corners[#corners + 1] = r * math.sin(turn)
  corners[#corners + 1] = z
end
local hull = new("Transform", "/usr/scene/space/place"):new("ConvexCollider", "hull")
print("the hull begins")
hull.vertices = corners
print("the hull is made")
"""

with tempfile.TemporaryDirectory() as folder:
    config = Path(folder) / "huge.lua"
    config.write_text(CONFIG)
    host = subprocess.Popen([Path(os.environ["SPARKBIN"]) / "sparkhost", "--config", config, "--duration", "1"],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    seen = ""
    for line in host.stderr:
        seen += line
        if "the hull begins" in line:
            host.send_signal(signal.SIGTERM)
    out = host.stdout.read()
    code = host.wait()

for what, good in [("the hull began", "the hull begins" in seen),
                   ("the host ended before the hull was made", "the hull is made" not in seen),
                   ("it says why", "stopped by a signal while loading" in seen or "was asked to end" in seen),
                   (f"its exit code is {code}", code == 2), ("stdout is empty", out == "")]:
    print(("right: " if good else "wrong: ") + what)
