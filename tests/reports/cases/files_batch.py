#!/usr/bin/env python3
# row: 20
# input: the runs of a batch would write one file
# right: refused before the first run; with {run} in the name each has its own
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

WRITES = WORLD + """
monitors{ port = 0 }
local file, push = option{ name = "log", default = "all.log" }, option{ name = "push", default = 1 }
new("MonitorLog", "/sys/server/monitor/log").file = file
"""
with Folder() as folder:
    (folder / "writes.lua").write_text(WRITES)
    batch = ["sparkbatch", "--config", "writes.lua", "--duration", "0.4", "--threads", "1", "--results", "t.csv"]
    for what, arguments in {
        "a name of the config": ["--runs", "3"],
        "a name of the command line": ["--runs", "2", "--set", "log=one.log"],
        "a name with the seed only, with a sweep": ["--sweep", "push=1,2", "--set", "log={seed}.log"],
        "a swept name, with seeds": ["--sweep", "log=a.log,b.log", "--runs", "2"],
        "a swept name, with another sweep": ["--sweep", "push=1,2", "--sweep", "log=a.log,b.log"],
    }.items():
        done = run(*batch, *arguments, cwd=folder)
        judge(f"{what}: refused", done.returncode == 2 and "would both write" in done.stderr and "{run}" in done.stderr,
              f"{done.returncode} {done.stderr}")
    judge(
        "nothing was written",
        not list(folder.glob("*.log")) and not (folder / "t.csv").exists(),
        list(folder.iterdir()),
    )
    done = run(*batch, "--runs", "3", "--sweep", "push=1,2", "--set", "log=run{run}.log", cwd=folder)
    judge(
        "a name for each run",
        done.returncode == 0 and len(list(folder.glob("run*.log"))) == 6,
        f"{done.returncode} {done.stderr}",
    )
    sizes = {f.stat().st_size for f in folder.glob("run*.log")}
    judge("each log is whole", len(sizes) == 1 and 0 not in sizes, sizes)
    done = run(*batch[:-1], "single.csv", cwd=folder)
    judge(
        "a batch of one run may write what its config names",
        done.returncode == 0 and (folder / "all.log").stat().st_size > 0,
        done.stderr,
    )
