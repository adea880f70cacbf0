#!/usr/bin/env python3
# row: C2
# input: a recording into a pipe whose reader stops reading; then SIGTERM
# right: the run goes on, and ends; the log says that the recording lacks its end
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
from programs import *  # noqa: E402,F403

import fcntl
import os
import re
import select
import threading

with Folder() as folder:
    os.mkfifo(folder / "pipe")
    started, ends = threading.Event(), []

    def read():
        """Reads until the host has started, and then nothing."""
        ends.append(os.open(folder / "pipe", os.O_RDONLY | os.O_NONBLOCK))
        fcntl.fcntl(ends[0], fcntl.F_SETPIPE_SZ, 4096)
        opened.set()
        while not started.is_set():
            if select.select(ends, [], [], 0.05)[0]:
                os.read(ends[0], 1 << 16)

    opened = threading.Event()
    reader = threading.Thread(target=read)
    reader.start()
    opened.wait()
    running = Live(
        "--config", "world.lua", "--record", "pipe", "--rate", "max", "--set", "/sys/host/tape.every=0.1", cwd=folder
    )
    started.set()
    reader.join()
    cycles = []
    while len(cycles) < 1000 and (not cycles or cycles[-1] < 3000):
        seen = re.search(r"[0-9]+", running.ctl("get", "/sys/server/simulation.cycle").stdout)
        cycles.append(int(seen.group()) if seen else 0)
    judge("the run goes on", cycles[-1] >= 3000, cycles[-1])
    code, log = running.stop()
    judge("it ends when it is told to", code == 0, log)
    judge("and says what is missing", "lacks its end" in log or "ends at" in log, log)
    os.close(ends[0])
