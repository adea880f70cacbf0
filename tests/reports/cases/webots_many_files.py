#!/usr/bin/env python3
# row: 8
# input: a world that names three thousand PROTOs of which none is there, and uses each of them
# right: the world is read; nodes are empty, appearances grey, and each kind is named or counted
import os
import subprocess
import tempfile
from pathlib import Path

COUNT = 3000
with tempfile.TemporaryDirectory() as folder:
    lines = ["#VRML_SIM R2023b utf8"]
    for i in range(COUNT):
        lines.append(f'EXTERNPROTO "https://example.org/m/R2023b/projects/looks/protos/Look{i}.proto"')
    lines.append("Look0 { }")
    for i in range(COUNT):
        lines.append(f'Solid {{ name "s{i}" children Shape {{ appearance Look{i} {{ }} geometry Box {{ }} }} }}')
    Path(folder, "many.wbt").write_text("\n".join(lines))
    Path(folder, "many.lua").write_text(
        'include "house.lua"\nfiles() scene() physics() simulation()\nget("/usr/scene"):importScene("many.wbt")\n'
        'print(get("/usr/scene/s2999") and "the last one is there")\n'
    )
    done = subprocess.run(
        [
            f"{os.environ['SPARKBIN']}/sparkhost",
            "--config",
            f"{folder}/many.lua",
            "--scene-path",
            folder,
            "--rate",
            "max",
            "--duration",
            "0.02",
        ],
        capture_output=True,
        text=True,
    )
    log = done.stderr
    good = done.returncode == 0
    print(f"{'right' if good else 'wrong'}: exit code {done.returncode} {'' if good else log[-300:]}")
    for text in (
        "the last one is there",
        "the appearance Look0 is a PROTO that is not there",
        "a node 'Look0' is empty",
    ):
        print(f"{'right' if text in log else 'wrong'}: {text}")
