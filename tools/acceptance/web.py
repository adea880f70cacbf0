"""The milestone `web`: the viewer in the browser. For the points with figures the machine should be idle otherwise."""
import contextlib
import json
import os
import re
import statistics
import subprocess
import time
from pathlib import Path

from acceptance.common import BIN, FAIL, OPEN, PASS, REPORTS, ROOT, last_check, run, say, tests

SPECTATORS = 100
CYCLE = 0.02  # s
ROUNDS = 7  # number of rounds, each with one block per crowd
BLOCK, CHANGE = 100, 50  # cycles of a block, and cycles between two blocks, in which spectators connect or disconnect
FIRST = 300  # cycle of the first block, when the robots exist and walk
FUZZERS = ("fuzz-web-http", "fuzz-web-socket", "fuzz-draw")
SCREENSHOTS = ROOT / "build/release/web-screenshots"


def judge(*good):
    return PASS if all(good) else FAIL


def worst(*verdicts):
    return next((v for v in (FAIL, OPEN) if v in verdicts), PASS)


# ---- watching ----

def link():
    """The line of tools/play that ends its set-up, and whether it was the last one before the match."""
    say("Playing")
    played = run([ROOT / "tools/play"], stderr=subprocess.PIPE)
    lines = [l for l in played.stderr.splitlines() if l.startswith("==")]
    found = [i for i, l in enumerate(lines) if re.search(r"http://127\.0\.0\.1:\d+/", l)]
    good = played.returncode == 0 and found and lines[found[-1] + 1:] == ["== Result"]
    return f"tools/play: {lines[found[-1]][3:] if found else 'no link'} (exit {played.returncode})", judge(good)


def frame_rate():
    say("Drawing a replay")
    measured = json.loads(run(["node", ROOT / "tests/web/frame_rate.mjs"]).stdout)
    return (f"{measured['framesPerSecond']:.1f} pictures/s of {measured['robots']} humanoids, {measured['quality']}, {measured['width']} x {measured['height']}, "
            f"software WebGL on {measured['cores']} cores (aim 30)")


def watching():
    first, linked = link()
    tested, shown = tests("browser-.*", "web-watching")
    pictures = len(list(SCREENSHOTS.glob("*.png")))
    return f"{first}; {tested}; {pictures} screenshots in {SCREENSHOTS.relative_to(ROOT)}; {frame_rate()}", worst(linked, shown)


# ---- spectators ----

class Match:
    """22 humanoids in real time, playing inside the host."""

    def __enter__(self):
        self.host = subprocess.Popen(
            [BIN / "sparkhost", "--config", "soccer.lua", "--sync", "--seed", "7", "--set", "team=Red Blue", "--set", "Soccer.AutomaticKickOff=true", "--set", "Soccer.WaitBeforeKickOff=1",
             "--agent-port", "0", "--monitor-port", "0", "--web-port", "0", "--log-level", "error"], stdout=subprocess.PIPE, text=True)
        self.port = int(re.search(r":(\d+)/", json.loads(self.host.stdout.readline())["web"])[1])
        return self

    def __exit__(self, *_):
        self.host.terminate()
        self.host.wait()

    def used(self):
        """Number of cycles so far, and processor seconds that the simulation thread has used for them."""
        cycle = run([BIN / "sparkctl", "--pid", str(self.host.pid), "get", "/sys/server/simulation.cycle"]).stdout
        thread = Path(f"/proc/{self.host.pid}/task/{self.host.pid}/schedstat").read_text()
        return int(re.search(r"= (\d+)", cycle)[1]), int(thread.split()[0]) * 1e-9

    def wait(self, cycle):
        """Waits until that cycle; the match runs at its own pace."""
        while (left := cycle - self.used()[0]) > 0:
            time.sleep(left * CYCLE)

    def cost(self, first):
        """Processor time of the simulation thread for a cycle [s], mean of the block that begins with cycle `first`."""
        self.wait(first)
        begun, before = self.used()
        self.wait(first + BLOCK)
        ended, after = self.used()
        return (after - before) / (ended - begun)

    def resident(self):
        line = next(l for l in Path(f"/proc/{self.host.pid}/status").read_text().splitlines() if l.startswith("VmRSS"))
        return int(line.split()[1]) / 1024


class Crowd:
    """Spectators over loopback; inside the context all are connected and receive the match."""

    def __init__(self, match, *arguments):
        self.command = [str(c) for c in (BIN / "web-spectators", "--port", match.port, *arguments)]

    def __enter__(self):
        # lower priority, so that on few processors the crowd does not take processor time from the host
        self.program = subprocess.Popen(self.command, stdout=subprocess.PIPE, text=True, preexec_fn=lambda: os.nice(10))
        self.program.stdout.readline()
        return self

    def __exit__(self, *_):
        self.program.terminate()
        self.said = json.loads(self.program.communicate()[0].strip().splitlines()[-1])


def blocks(first_kind, crowds, said):
    """One match in whose blocks the crowds take turns, beginning with `first_kind`: the simulation thread's cost in each, and by how much
    memory grew meanwhile [MB]."""
    costs = []
    with Match() as match:
        match.wait(FIRST - CHANGE)
        before = match.resident()
        for block in range(ROUNDS * len(crowds)):
            kind = (first_kind + block) % len(crowds)
            with Crowd(match, *crowds[kind]) if crowds[kind] else contextlib.nullcontext() as present:
                costs.append(match.cost(FIRST + block * (BLOCK + CHANGE)))
            if present:
                said[kind].append(present.said)
        return costs, match.resident() - before


def spectators():
    """The same match as often as there are crowds, so that each cycle is simulated with every one of them. A match as a whole is some percent
    faster or slower than the next, as its memory happens to lie: the mean of a round, in which each match has each crowd once, is free of that."""
    crowds = [(), ("--count", SPECTATORS), ("--count", 0, "--stalled", 20)]
    kinds = len(crowds)
    said = [[] for _ in crowds]
    matches, grown = [], []
    for first_kind in range(kinds):
        say(f"Watching match {first_kind + 1} of {kinds}")
        costs, growth = blocks(first_kind, crowds, said)
        matches.append(costs)
        grown.append(growth)

    def cost(block, kind):
        return matches[(kind - block) % kinds][block]

    def ratio(kind):
        rounds = [statistics.geometric_mean(cost(block, kind) / cost(block, 0) for block in range(r * kinds, (r + 1) * kinds)) for r in range(ROUNDS)]
        say(f"Rounds with {' '.join(map(str, crowds[kind]))}: " + " ".join(f"{r:.3f}" for r in rounds))
        return statistics.median(rounds)

    watched, stalled = ratio(1), ratio(2)
    bytes_each = max(s["bytesPerSecond"]["max"] for s in said[1])
    frames = statistics.median(s["framesPerSecond"]["median"] for s in said[1])
    bad = sum(s["badFrames"] for s in said[1])
    measured = (f"{SPECTATORS} spectators: {watched:.3f} x the simulation thread's CPU per cycle (median of {ROUNDS} rounds of blocks, each simulated with and without), "
                f"{bytes_each / 1000:.0f} kB/s each at most, {frames:.1f} frames/s, {bad} bad frames; 20 stalled ones: {stalled:.3f} x; {max(grown):+.1f} MB")
    return measured, judge(watched <= 1.02, bytes_each <= 100e3, stalled <= 1.02, not bad)


# ---- the rest ----

def fuzzed():
    """The result of the last tools/check for this milestone's fuzzers."""
    failures = (REPORTS / "failures").read_text() if (REPORTS / "failures").exists() else ""
    missing = [f for f in FUZZERS if not (REPORTS / f"{f}.log").exists()]
    failed = [f for f in FUZZERS if f in failures]
    measured = f"fuzzers of the last tools/check: {', '.join(FUZZERS)}" + (f"; not run: {', '.join(missing)}" if missing else "") + (f"; failed: {', '.join(failed)}" if failed else "")
    return measured, FAIL if failed else OPEN if missing else PASS


def hostile():
    tested, held = tests("web-hostile", "web-service", "monitor-web")
    fuzz, clean = fuzzed()
    return f"{tested}; {fuzz}", worst(held, clean)


def unit_tests():
    tested, good = tests("viewer-unit")
    return tested + " (of tools/check too)", good


def check():
    found = last_check("plain", "all", "long")
    if not found:
        return "tools/check has not run here", OPEN
    mode, said, stages = found
    return f"the last tools/check ({mode}): {said}; {stages[-1]}", judge(", 0 failed" in said)


POINTS = {
    "1": ("the link leads to the running match; the browser tests pass", watching),
    "2": ("100 spectators: at most 1.02 x the simulation thread's CPU, 100 kB/s each; stalled ones cost nothing", spectators),
    "3": ("hostile input harms nobody; the readers are fuzzed", hostile),
    "4": ("the viewer's own unit tests", unit_tests),
    "5": ("tools/check passes", check),
}
