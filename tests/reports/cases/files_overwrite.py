#!/usr/bin/env python3
# row: 20
# input: every program writes under a name that exists
# right: it refuses and says what to do; with --force it replaces the file
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

with Folder() as folder:
    model = folder / "arm.urdf"
    model.write_text("<robot name='r'><link name='base'><inertial><mass value='1'/>"
                     "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>")
    (folder / "logged.lua").write_text(WORLD + """
include "soccer-house.lua"
""".replace("include", "-- include") + """
monitors{ port = 0 }
local file = option{ name = "log", default = "" }
if file ~= "" then new("MonitorLog", "/sys/server/monitor/log").file = file end
""")
    record = host("--config", "world.lua", "--duration", "1", "--record", "a.mcap", cwd=folder)
    judge("the first recording is made", record.returncode == 0, record.stderr)
    ways = {
        "sparkhost --record": [
            "sparkhost",
            "--rate",
            "max",
            "--config",
            "world.lua",
            "--duration",
            "0.4",
            "--record",
            "out",
        ],
        "sparkhost --hashes": [
            "sparkhost",
            "--rate",
            "max",
            "--config",
            "world.lua",
            "--duration",
            "0.4",
            "--hashes",
            "out",
        ],
        "sparkhost --convert": ["sparkhost", "--convert", "arm.urdf", "out"],
        "a monitor log": [
            "sparkhost",
            "--rate",
            "max",
            "--config",
            "logged.lua",
            "--duration",
            "0.4",
            "--set",
            "log=out",
            "--monitor-port",
            "0",
        ],
        "sparkreplay --export a part": ["sparkreplay", "a.mcap", "--export", "out.mcap"],
        "sparkreplay --export a table": [
            "sparkreplay",
            "a.mcap",
            "--export",
            "out.csv",
            "--property",
            "/usr/scene/arm.localPos",
        ],
        "a table of sparkbatch": ["sparkbatch", "--config", "world.lua", "--duration", "0.4", "--results", "out.csv"],
        "the description of a batch": [
            "sparkbatch",
            "--config",
            "world.lua",
            "--duration",
            "0.4",
            "--results",
            "free.csv",
        ],
    }
    for name, command in ways.items():
        out = folder / next(
            (
                "free.csv.batch" if w == "free.csv" else w
                for w in command
                if w.startswith(("out", "log=", "logFile=", "free"))
            )
        )
        out = folder / out.name.removeprefix("log=").removeprefix("logFile=")
        out.write_text("years of work\n")
        done = run(*command, cwd=folder)
        judge(f"{name}: refused", done.returncode == 2 and "--force" in done.stderr, f"{done.returncode} {done.stderr}")
        judge(f"{name}: the file is kept", out.read_text() == "years of work\n")
        done = run(*command, "--force", cwd=folder)
        judge(f"{name}: --force replaces it", done.returncode == 0 and out.read_bytes()[:13] != b"years of work",
              f"{done.returncode} {done.stderr}")
        out.unlink()
    (folder / "log.txt").write_text("years of work\n")
    done = host("--config", "world.lua", "--duration", "0.4", "--set", "logFile=log.txt", cwd=folder)
    judge(
        "a log continues a text",
        done.returncode == 0 and (folder / "log.txt").read_text().startswith("years of work\n"),
        done.stderr,
    )
    (folder / "picture").write_bytes(bytes(range(256)))
    done = host("--config", "world.lua", "--duration", "0.4", "--set", "logFile=picture", cwd=folder)
    judge(
        "but nothing else", done.returncode == 2 and (folder / "picture").read_bytes() == bytes(range(256)), done.stderr
    )
    running = Live("--config", "world.lua", cwd=folder)
    (folder / "s.mcap").write_text("years of work")
    done = running.ctl("snapshot", folder / "s.mcap")
    judge(
        "a snapshot: refused",
        done.returncode == 1 and "--force" in done.stderr and (folder / "s.mcap").read_text() == "years of work",
        done.stderr,
    )
    done = running.ctl("snapshot", "--force", folder / "s.mcap")
    judge(
        "a snapshot: --force replaces it",
        done.returncode == 0 and (folder / "s.mcap").stat().st_size > 100,
        done.stderr,
    )
    running.stop()
    left = sorted(p.name for p in folder.iterdir())
    judge(
        "nothing else is left in the folder",
        not [n for n in left if n.startswith(("out", "free", "s.mcap.")) and n not in ("out.csv.batch", "free.csv")],
        left,
    )
