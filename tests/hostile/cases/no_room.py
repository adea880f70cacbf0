#!/usr/bin/env python3
# row: B6
# input: a limit of file sizes is reached by recordings, hashes, logs and tables
# right: one line says so, and the run goes on to its end, or ends with an error
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
from programs import *  # noqa: E402,F403

import resource


def limit():
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))


with Folder() as folder:
    (folder / "watched.lua").write_text(
        WORLD + "monitors{ port = 0 }\nnew('MonitorLog', '/sys/server/monitor/log').file = 'm.log'\n"
    )
    for what, arguments in {
        "a recording": ["--record", "a.mcap"],
        "hashes": ["--hashes", "h"],
        "a log": ["--set", "logFile=l.txt", "--set", "/sys/server/log/file.level=trace"],
        "a monitor log": ["--config", "watched.lua"],
    }.items():
        done = host("--config", "world.lua", "--duration", "20", *arguments, cwd=folder, preexec_fn=limit)
        lines = done.stdout.splitlines()
        judge(
            f"{what}: the run ends as planned",
            done.returncode == 0 and lines and json.loads(lines[-1])["simSeconds"] == 20,
            f"{done.returncode} {done.stderr}",
        )
        judge(f"{what}: it is said", "File too large" in done.stderr or what == "a log", done.stderr)
    done = run(
        "sparkbatch",
        "--config",
        "world.lua",
        "--runs",
        "60",
        "--duration",
        "0.1",
        "--threads",
        "1",
        "--results",
        "t.csv",
        cwd=folder,
        preexec_fn=limit,
    )
    judge(
        "a table: an error",
        done.returncode in (1, 2, 3) and "File too large" in done.stderr,
        f"{done.returncode} {done.stderr}",
    )
