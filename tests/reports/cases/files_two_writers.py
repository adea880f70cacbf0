#!/usr/bin/env python3
# row: 20
# input: two runs, and their logs and snapshots, want one file at a time
# right: the second is refused, the first stays whole
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

with Folder() as folder:
    first = Live("--config", "world.lua", "--record", "both.mcap", "--set", "logFile=run.txt", cwd=folder)
    for what, arguments in {
        "a second recording": ["--record", "both.mcap"],
        "a second recording with --force": ["--record", "both.mcap", "--force"],
        "hashes with --force": ["--hashes", "both.mcap", "--force"],
        "a second log file": ["--set", "logFile=run.txt"],
        "a log in the recording": ["--set", "logFile=both.mcap", "--force"],
    }.items():
        done = host("--config", "world.lua", "--duration", "0.4", *arguments, cwd=folder)
        judge(
            f"{what} is refused",
            done.returncode == 2
            and ("another run is writing it" in done.stderr or "it is there already" in done.stderr),
            f"{done.returncode} {done.stderr}",
        )
    for what, file in {"a snapshot": "both.mcap", "a snapshot by another name": "./x/../both.mcap"}.items():
        (folder / "x").mkdir(exist_ok=True)
        done = first.ctl("snapshot", "--force", str(folder) + "/" + file)
        judge(f"{what} over the recording is refused", done.returncode == 1, done.stderr)
    done = first.ctl("set", "/sys/server/log/file.file", folder / "both.mcap")
    judge("log lines into the recording are refused", done.returncode == 1, done.stderr)
    code, log = first.stop()
    judge("the first run ends well", code == 0, log)
    code, line, log = verify(folder / "both.mcap")
    judge("and its recording is whole", code == 0 and line["differs"] is None and not line["lacks"], f"{line} {log}")
