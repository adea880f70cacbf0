#!/usr/bin/env python3
# row: C1
# input: stdout and stderr are pipes whose readers have gone, at once or on the way, or are closed
# right: the run goes on to its end; an exit code, no signal
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
from programs import *  # noqa: E402,F403

import os

with Folder() as folder:
    (folder / "talks.lua").write_text(
        WORLD
        + "on('rule', function(_, event) if event.cycle % 5 == 0 then log.warning('cycle ' .. event.cycle) end end)\n"
    )

    def gone(*arguments, first=False, program="sparkhost"):
        read, write = os.pipe()
        process = subprocess.Popen(
            [str(a) for a in (BIN / program, *arguments)], stdout=write, stderr=write, cwd=folder
        )
        os.close(write)
        if first:
            os.read(read, 1)
        os.close(read)
        return process.wait(timeout=120)

    code = gone("--config", "talks.lua", "--rate", "max", "--duration", "10", "--hashes", "h1")
    judge("readers gone at once: an exit code", code == 1, code)
    judge("and the whole run", len((folder / "h1").read_text().splitlines()) == 500)
    code = gone("--config", "talks.lua", "--rate", "max", "--duration", "10", "--hashes", "h2", first=True)
    judge("readers gone on the way: an exit code", code == 1, code)
    judge("and the whole run, too", len((folder / "h2").read_text().splitlines()) == 500)
    code = gone("--config", "none.lua")
    judge("an error that cannot be told is an exit code", code == 2, code)
    code = gone("--config", "talks.lua", "--runs", "2", "--duration", "1", "--results", "t.csv", program="sparkbatch")
    judge("a batch ends with its table", code >= 0 and len((folder / "t.csv").read_text().splitlines()) == 3, code)
    code = gone("nothing.mcap", program="sparkreplay")
    judge("sparkreplay ends with its code", code == 2, code)
    process = subprocess.Popen(
        [BIN / "sparkhost", "--config", "talks.lua", "--rate", "max", "--duration", "5", "--hashes", "h3"],
        cwd=folder,
        preexec_fn=lambda: (os.close(1), os.close(2)),
    )
    code = process.wait(timeout=120)
    judge(
        "both closed: an exit code and the whole run",
        code >= 0 and len((folder / "h3").read_text().splitlines()) == 250,
        code,
    )
