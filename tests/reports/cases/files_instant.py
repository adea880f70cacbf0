#!/usr/bin/env python3
# row: 22
# input: a run goes on at an instant between two recorded states, alone and in a batch
# right: at that instant, with the hashes of the recorded run; otherwise it is refused
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

with Folder() as folder:
    done = host(
        "--config",
        "world.lua",
        "--duration",
        "25",
        "--record",
        "a.mcap",
        "--hashes",
        "h0",
        "--set",
        "/sys/host/tape.every=8",
        cwd=folder,
    )
    judge("settings of the tape have an effect with --record", done.returncode == 0, done.stderr)
    whole = dict(line.split(" ", 1) for line in (folder / "h0").read_text().splitlines())
    for at, cycle in {"13": 650, "12.99": 649, "16": 800, "16.02": 801, "24.98": 1249, "0.5": 25}.items():
        done = host("--from", "a.mcap", f"--at={at}", "--duration", "25", "--hashes", "h1", "--force", cwd=folder)
        lines = (folder / "h1").read_text().splitlines() if (folder / "h1").exists() and done.returncode == 0 else []
        good = (
            bool(lines)
            and lines[0].split()[0] == str(cycle + 1)
            and all(whole[n] == rest for n, rest in (l.split(" ", 1) for l in lines))
        )
        judge(f"--at {at} goes on with cycle {cycle + 1} and the hashes of the run", good, (lines[:1], done.stderr))
    for at, why in {"40": "ends at 25", "-1": "has no state up to -1 s"}.items():
        done = host("--from", "a.mcap", f"--at={at}", "--duration", "50", cwd=folder)
        judge(f"--at {at} is refused", done.returncode == 2 and why in done.stderr, done.stderr)
    done = host("--from", "a.mcap", "--at", "13", "--duration", "12", cwd=folder)
    judge(
        "a duration that is over is named",
        done.returncode == 0 and "goes on at 13.00 s" in done.stderr,
        f"{done.returncode} {done.stderr}",
    )
    batch = run(
        "sparkbatch",
        "--from",
        "a.mcap",
        "--at",
        "13",
        "--runs",
        "2",
        "--seed",
        "1",
        "--duration",
        "25",
        "--threads",
        "1",
        "--results",
        "b.jsonl",
        cwd=folder,
    )
    rows = [json.loads(line) for line in (folder / "b.jsonl").read_text().splitlines()] if batch.returncode == 0 else []
    ends = {row["run"]: row["stateHash"] for row in rows}
    judge("a batch branches there: the recorded seed ends as the run did, another elsewhere",
          len(rows) == 2 and ends[1] == whole["1250"].split()[0] and ends[2] != ends[1], batch.stderr)
    judge("and counts the seconds that it ran", rows and json.loads(batch.stdout)["simSeconds"] == 24, batch.stdout)
    batch = run("sparkbatch", "--from", "a.mcap", "--at", "13", "--duration", "13", "--results", "c.jsonl", cwd=folder)
    judge(
        "a batch without a cycle is refused",
        batch.returncode == 2 and "goes on at 13.00 s" in batch.stderr,
        f"{batch.returncode} {batch.stderr}",
    )
    done = host(
        "--from",
        "a.mcap",
        "--at",
        "13",
        "--duration",
        "20",
        "--record",
        "on.mcap",
        "--set",
        "/sys/host/tape.every=1",
        cwd=folder,
    )
    code, line, log = verify(folder / "on.mcap") if done.returncode == 0 else (done.returncode, {}, done.stderr)
    judge(
        "a run that goes on is recorded with settings of its own tape",
        code == 0 and line["cycles"] == 350 and line["states"] >= 7,
        f"{line} {log}",
    )
    running = Live("--config", "world.lua", "--duration", "5", cwd=folder)
    running.ctl("snapshot", folder / "s.mcap")
    running.stop()
    done = host("--from", "s.mcap", "--at", "30", "--duration", "40", cwd=folder)
    judge(
        "a snapshot, which has no inputs, is refused for another instant",
        done.returncode == 2 and "is a snapshot" in done.stderr,
        done.stderr,
    )
