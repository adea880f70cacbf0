#!/usr/bin/env python3
# row: 24
# input: numbers on command lines that begin with a minus and no digit
# right: they are numbers, wherever they stand
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

with Folder() as folder:
    running = Live("--config", "world.lua", cwd=folder)
    for value, text in {"-.5": "-0.5", "-1e-5": "-1e-05", "-5": "-5", ".25": "0.25"}.items():
        done = running.ctl("set", "/usr/scene/arm/body.mass", value)
        good = (
            value[0] != "-"
            and done.returncode == 0
            or value[0] == "-"
            and "expected" in done.stderr
            and "--help" not in done.stderr
        )
        judge(f"set mass {value} reaches the property", good, done.stdout + done.stderr)
    done = running.ctl("call", "/usr/scene/arm/joint.setHighStopDeg", "0", "-.5")
    judge("call with -.5", done.returncode == 0, done.stderr)
    done = running.ctl("call", "/usr/scene/arm/body.setPosition", "-1", "-2", "-inf")
    judge(
        "call with -inf is refused by the body, not by the command line",
        done.returncode in (0, 1) and "--help" not in done.stderr,
        done.stderr,
    )
    done = running.ctl("set", "--timeout", "5", "/usr/scene/arm/body.mass", "2")
    judge("options still work", done.returncode != 0 or "2" in done.stdout, done.stderr)
    done = running.ctl("call", "/usr/scene/arm/body.setPosition", "-1", "-.25", "-3", "--timeout")
    judge("words that are no numbers are options", done.returncode == 2, done.stderr)
    running.stop()
