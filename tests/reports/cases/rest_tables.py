# row: 24
# input: the same vector in a table of sparkreplay and in one of sparkbatch, and the time of a run of three seconds
# right: both have it in the same form, and the time is 3
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
from programs import *  # noqa: E402,F403

WORLD = """include "house.lua"
files() scene() simulation()
new("Transform", "/usr/scene/arm").localPos = { 1, 0.5, -2 }
"""
PROPERTY = "/usr/scene/arm.localPos"

with Folder() as folder:
    (folder / "arm.lua").write_text(WORLD)
    run("sparkhost", "--config", "arm.lua", "--rate", "max", "--duration", "3", "--record", "a.mcap", cwd=folder)
    run("sparkreplay", "a.mcap", "--export", "a.csv", "--property", PROPERTY, cwd=folder)
    run("sparkbatch", "--config", "arm.lua", "--duration", "3", "--report", PROPERTY, "--results", "b.csv", cwd=folder)
    replayed = next(csv.DictReader((folder / "a.csv").open()))
    batched = next(csv.DictReader((folder / "b.csv").open()))
    judge("a vector is " + replayed[PROPERTY], replayed[PROPERTY] == batched[PROPERTY] == "[1.0,0.5,-2.0]", batched)
    judge("simSeconds is " + batched["simSeconds"], float(batched["simSeconds"]) == 3, batched)
