#!/usr/bin/env python3
# row: A1
# input: a recording whose command line, settings or script write files
# right: none is written, new or old, but those that the command line of today names
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
import mcap  # noqa: E402
from programs import *  # noqa: E402,F403

with Folder() as folder:
    (folder / "watched.lua").write_text(WORLD + "monitors{ port = 0 }\n")
    host("--config", "watched.lua", "--duration", "1", "--record", "a.mcap", cwd=folder)
    records = mcap.records(folder / "a.mcap")
    before = json.loads(mcap.about(records)["arguments"])
    text = (folder / "watched.lua").read_text()
    script = lambda line: (before, text + line + "\n")
    for file, old in ((folder / "old", True), (folder / "new", False)):
        ways = {
            "--convert": (before + ["--convert", "rsg/boxspheres/yard.rsg", str(file)], text),
            "--record": (before + ["--record", str(file)], text),
            "--record=": (before + [f"--record={file}"], text),
            "--hashes": (before + ["--hashes", str(file)], text),
            "--force": (before + ["--force", "--set", f"logFile={file}"], text),
            "logFile": (before + ["--set", f"logFile={file}"], text),
            "a MonitorLog": script(f'new("MonitorLog", "/sys/server/monitor/log").file = "{file}"'),
            "a FileLogSink": script(f'get("/sys/server/log"):new("FileLogSink", "mine").file = "{file}"'),
            "a setting of a FileLogSink": (
                before + ["--set", f"/sys/server/log/mine.file={file}"],
                text + 'get("/sys/server/log"):new("FileLogSink", "mine")\n',
            ),
            "a snapshot": script(
                f'on("rule", function() pcall(function() get("/sys/host/snapshots"):save("{file}") end) end)'
            ),
            "a second recording": script(
                f'on("rule", function() pcall(function() get("/sys/host/tape"):record("{file}", {{}}) end) end)'
            ),
        }
        for what, (arguments, config) in ways.items():
            mcap.write(folder / "b.mcap", mcap.forged(records, arguments, {"watched.lua": config}))
            for command in (
                ["sparkreplay", "b.mcap", "--verify"],
                ["sparkhost", "--from", "b.mcap", "--rate", "max", "--duration", "1.5"],
                [
                    "sparkhost",
                    "--from",
                    "b.mcap",
                    "--rate",
                    "max",
                    "--duration",
                    "1.5",
                    "--record",
                    "c.mcap",
                    "--force",
                ],
            ):
                if old:
                    file.write_text("mine")
                done = run(*command, cwd=folder)
                judge(f"{what}, a file that is {'there' if old else 'new'}: {' '.join(command[:2])}",
                      (file.read_text() == "mine" if old else not file.exists()) and done.returncode >= 0, done.stderr)
                if "FileLogSink" in what:
                    judge(f"{what}: the log names the file and why it is not written",
                          f"/sys/server/log/mine.file: {file} is not written, since a recording names it" in done.stderr, done.stderr)
                file.unlink(missing_ok=True)
    mcap.write(
        folder / "b.mcap", mcap.forged(records, before + ["--set", f"logFile={folder / 'new'}"], {"watched.lua": text})
    )
    done = host("--from", "b.mcap", "--duration", "1.5", "--set", "logFile=own.txt", "--log-level", "info", cwd=folder)
    judge(
        "a log that the user names is written, in the user's folder",
        done.returncode == 0 and (folder / "own.txt").exists(),
        done.stderr,
    )
