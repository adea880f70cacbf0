#!/usr/bin/env python3
# row: 3
# input: all configs of lua/ that are worlds of their own run for some cycles
# right: each line on stdout is JSON, the first with the ports, the last with the result
import concurrent.futures
import json
import os
import subprocess
from pathlib import Path

LUA = Path(__file__).resolve().parents[3] / "lua"
# Parts of configs, and those that need a file, another host or a helper.
OTHERS = {
    "camera",
    "convert",
    "course",
    "house",
    "listings",
    "logplayer",
    "materials",
    "naotypes",
    "referee",
    "robots",
    "shot_clock",
    "soccer-house",
}


def start(config):
    """The finished host, with free ports for all that the config has a port for."""
    ports = ["agent", "monitor", "web"]
    while True:
        command = [
            Path(os.environ["SPARKBIN"]) / "sparkhost",
            "--config",
            config,
            "--rate",
            "max",
            "--duration",
            "0.1",
            "--log-level",
            "error",
        ]
        words = [word for name in ports for word in (f"--{name}-port", "0")]
        done = subprocess.run([*map(str, command), *words], capture_output=True, text=True, errors="replace")
        refused = [name for name in ports if f"sparkhost: --{name}-port 0:" in done.stderr]
        if not refused:
            return done
        ports.remove(refused[0])


def run(config):
    """What is wrong with its stdout; "" if nothing is."""
    done = start(config)
    lines = done.stdout.splitlines()
    try:
        documents = [json.loads(line) for line in lines]
    except ValueError as error:
        return f"{error} in {lines}"
    if len(documents) != 2 or "cycles" not in documents[1]:
        return f"expected two lines, found {lines}; {done.stderr[:200]}"
    return ""


configs = sorted(file for file in LUA.glob("*.lua") if file.stem not in OTHERS)
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    wrong = {c.name: w for c, w in zip(configs, pool.map(run, configs)) if w}
for name, what in wrong.items():
    print(f"wrong: {name}: {what}")
if not wrong:
    print(f"right: {len(configs)} configs")
