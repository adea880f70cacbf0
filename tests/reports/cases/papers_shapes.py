#!/usr/bin/env python3
# row: pF11
# input: sparkbatch sweeps width and height of a body, which a script builds
# right: a row for each shape, with the height at which it stands and the mass that it has
import csv
import os
import subprocess
import tempfile
from pathlib import Path

BIN = Path(os.environ["SPARKBIN"])
CONFIG = """
include "house.lua"
local width = option{ name = "width", default = 3, doc = "Of the body [0.1 m]." }
local length = option{ name = "length", default = 0.2, doc = "Half its height [m]." }
files() scene() physics("ArticulatedEngine") simulation()
results{ height = 0, mass = 0 }
new("PlaneCollider", "/usr/scene/ground"):new("ContactJointHandler", "surface")
local place = new("Transform", "/usr/scene/space/walker")
place.localPos = { 0, 0, length + 0.1 }
local body = place:new("RigidBody", "body")
body:setBoxTotal(1 + width, 0.1 * width, 0.4, 2 * length)
local collider = place:new("BoxCollider", "collider")
collider.boxLengths = { 0.1 * width, 0.4, 2 * length }
collider:new("ContactJointHandler", "surface")
on("rule", function() Result.height, Result.mass = body.position[3], body.mass end)
"""


def judge(what, good):
    print(f"{'right' if good else 'wrong'}: {what}")


with tempfile.TemporaryDirectory() as folder:
    (Path(folder) / "config.lua").write_text(CONFIG)
    done = subprocess.run([BIN / "sparkbatch", "--config", "config.lua", "--sweep", "width=3,5", "--sweep", "length=0.1,0.3", "--duration", "2", "--results", "shapes.csv"],
                          cwd=folder, capture_output=True, text=True)
    judge(f"the batch ends well {done.stderr[-300:]}", done.returncode == 0)
    rows = list(csv.DictReader((Path(folder) / "shapes.csv").open()))
    judge(f"{len(rows)} shapes", len(rows) == 4)
    for row in rows:
        height, mass = float(row["height"]), float(row["mass"])
        judge(f"{row['width']} dm wide, {row['length']} m: stands at {height:.3f} m with {mass:g} kg",
              abs(height - float(row["length"])) < 0.01 and mass == 1 + float(row["width"]))
