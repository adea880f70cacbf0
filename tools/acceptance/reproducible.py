"""The milestone `reproducible`: what decides a match is in a hash, and one seed is one match however it is run."""
import contextlib
import itertools
import json
import os
import re
import socket
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from acceptance.common import BIN, FAIL, PASS, ROOT, build, say, tests
from acceptance.fresh import busy

SECONDS = 600  # of a match
EVERY = 50     # cycles between two hashes

# A solver, as options of the host.
SOLVERS = {
    "dense": ["--set", "solver=dense", "--set", "/sys/server/physics.exactReplay=false"],
    "dense with exactReplay": ["--set", "solver=dense", "--set", "/sys/server/physics.exactReplay=true"],
    "articulated": ["--set", "solver=articulated", "--set", "/sys/server/physics.exactReplay=false"],
}


@dataclass(frozen=True)
class Way:
    """One way to run a match; the match is the same whichever is taken."""
    threads: int = 1
    build: str = "release"
    plugins: str = "as listed"   # or backwards
    joins: str = "Red first"     # or Blue first, the last player first
    watched: bool = False        # by monitors and browsers
    busy: bool = False           # beside two busy processes

    def __str__(self):
        return (f"{self.threads} threads, {self.build}, plugins {self.plugins}, {self.joins}"
                f"{', watched' if self.watched else ''}{', beside two busy processes' if self.busy else ''}")


FACTORS = {"threads": (1, 2, 4), "build": ("release", "debug", "clang"), "plugins": ("as listed", "backwards"),
           "joins": ("Red first", "Blue first"), "watched": (False, True), "busy": (False, True)}


def pairwise(factors):
    """Few ways, such that any two values of two factors come together in one; the first one is the plainest."""
    def pairs(values):
        return set(itertools.combinations(zip(factors, values), 2))

    every = list(itertools.product(*factors.values()))
    left = set().union(*map(pairs, every)) - pairs(every[0])
    chosen = [every[0]]
    while left:
        chosen.append(max(every, key=lambda values: len(pairs(values) & left)))
        left -= pairs(chosen[-1])
    return [Way(*values) for values in chosen]


@dataclass(frozen=True)
class League:
    config: str
    team: str
    arguments: tuple = ()


SPHERES = League("soccer-sphere.lua", "sphere-team")
HUMANOIDS = League("soccer.lua", "humanoid-team", ("--set", "Soccer.AutomaticKickOff=true", "--set", "Soccer.WaitBeforeKickOff=5"))


@contextlib.contextmanager
def listening(port):
    """A monitor that reads all it gets."""
    def read(link):
        with contextlib.suppress(OSError):
            while link.recv(1 << 16):
                pass

    with socket.create_connection(("127.0.0.1", port)) as link:
        reader = threading.Thread(target=read, args=(link,))
        reader.start()
        yield
        with contextlib.suppress(OSError):
            link.shutdown(socket.SHUT_RDWR)
        reader.join()


@contextlib.contextmanager
def watching(bin, way, first):
    """Two monitors and three browsers, if the match is watched."""
    with contextlib.ExitStack() as stack:
        if way.watched:
            for _ in range(2):
                stack.enter_context(listening(first["monitorPort"]))
            crowd = subprocess.Popen([bin / "web-spectators", "--port", re.search(r":(\d+)/", first["web"])[1], "--count", "3"], stdout=subprocess.DEVNULL)
            stack.callback(crowd.wait)
            stack.callback(crowd.terminate)
        yield


def play(league, solver, way, seconds, players=11, record=None):
    """Plays a match of two teams over TCP in lockstep. Returns its result and the lines of its hashes: cycle, state, configuration."""
    bin = ROOT / "build" / way.build / "bin"
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        config = league.config
        if way.plugins == "backwards":
            plugins = sorted(p.stem for p in (BIN.parent / "plugins").glob("*.so"))  # one text for all builds
            config = Path(folder) / "backwards.lua"
            config.write_text("\n".join(f'plugin "{p}"' for p in reversed(plugins)) + f'\ninclude "{league.config}"\n')
        hashes = Path(folder) / "hashes"
        if way.busy:
            stack.enter_context(busy(2))
        host = subprocess.Popen(
            [bin / "sparkhost", "--config", config, "--seed", "7", "--rate", "max", "--sync", "--expect", str(2 * players), "--duration", str(seconds),
             "--agent-port", "0", "--monitor-port", "0", "--web-port", "0", "--log-level", "error", "--set", f"/sys/server/simulation.threads={way.threads}",
             "--hashes", hashes, "--hash-every", str(EVERY), *SOLVERS[solver], *league.arguments, *(["--record", record] if record else [])], stdout=subprocess.PIPE, text=True)
        stack.callback(host.wait)
        stack.callback(host.kill)
        first = json.loads(host.stdout.readline())
        with watching(bin, way, first):
            for team in ("Red", "Blue") if way.joins == "Red first" else ("Blue", "Red"):
                command = [bin / league.team, "--team", team, "--port", str(first["agentPort"]), "--players", str(players)]
                playing = subprocess.Popen(command + (["--reverse"] if way.joins == "Blue first" else []), stdout=subprocess.DEVNULL)
                stack.callback(playing.wait)
                stack.callback(playing.kill)
            result = json.loads(host.stdout.readline())
        return result, [line.split() for line in hashes.read_text().splitlines()]


def differs(lines, others):
    """Where the states of two matches differ; "" if nowhere."""
    for one, other in zip(lines, others):
        if one[:2] != other[:2]:
            return f"from cycle {other[0]} on"
    return "" if len(lines) == len(others) else f"after {len(others)} hashes instead of {len(lines)}"


def matrix(league, solver, seconds=SECONDS):
    """One match in all ways."""
    ways = pairwise(FACTORS)
    wrong, configurations = [], {}
    result = lines = None
    for way in ways:
        say(f"{league.config}, {solver}: {way}")
        result_now, lines_now = play(league, solver, way, seconds)
        if lines is None:
            result, lines = result_now, lines_now
        elif found := differs(lines, lines_now):
            wrong.append(f"{way} differs {found}")
        configurations.setdefault((way.threads, way.plugins), set()).update(line[2] for line in lines_now)
    moved = [key for key, found in configurations.items() if len(found) > 1]
    if moved:
        wrong.append(f"{len(moved)} of {len(configurations)} configurations have more than one hash")
    good = not wrong and len(lines) == seconds * 50 // EVERY and result["agentsSeen"] == 22
    return (f"{solver}, {league.config}, 11 v 11 over TCP, {result['simSeconds']:.0f} s, {result['score'][0]}:{result['score'][1]}: {len(ways)} ways, each value of a factor with "
            f"each of another, {len(lines)} hashes each, the last one {lines[-1][1]}{'; ' if wrong else ': all equal'}{'; '.join(wrong)}"), PASS if good else FAIL


def all_builds():
    for preset in ("debug", "clang"):
        build(preset, "sparkhost", "sphere-team", "humanoid-team", "web-spectators", "plugins")


def matches(solver):
    all_builds()
    judged = [matrix(league, solver) for league in (SPHERES, HUMANOIDS)]
    return "; ".join(measured for measured, _ in judged), FAIL if any(verdict == FAIL for _, verdict in judged) else PASS


def in_middle(league, seconds=SECONDS):
    """A recorded 11 v 11 over TCP goes on from states in its middle; cost and size of the recording."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "match.mcap"
        say(f"{league.config}: {seconds} s recorded")
        result, _ = play(league, "dense with exactReplay", Way(), seconds, record=file)
        size = file.stat().st_size / seconds / 1000
        judged, good = [], True
        for start in (0, seconds // 3, seconds // 2):
            done = subprocess.run([BIN / "sparkreplay", file, "--verify", "--log-level", "error", *(["--from", str(start)] if start else [])],
                                  stdout=subprocess.PIPE, text=True)
            line = json.loads(done.stdout)
            first = start - start % 10
            good &= done.returncode == 0 and line["differs"] is None and not line["lacks"] and line["cycles"] == 50 * (seconds - first)
            judged.append(f"from {first} s {line['cycles']} cycles {'equal' if line['differs'] is None else 'differ: ' + str(line['differs'])}")
    return f"{league.config}, 11 v 11 over TCP, {result['simSeconds']:.0f} s: {', '.join(judged)}; {size:.1f} kB/s, at most 60", PASS if good and size <= 60 else FAIL


def snapshots():
    """Runs that go on from a snapshot, 3000 cycles each, and matches over TCP."""
    judged = [tests("system-snapshot", environment={"SPARK_SNAPSHOT_CYCLES": "3000"}), in_middle(SPHERES), in_middle(HUMANOIDS)]
    return "; ".join(measured for measured, _ in judged), FAIL if any(verdict == FAIL for _, verdict in judged) else PASS


def cpu_of_simulation(arguments, seconds):
    """CPU time [s] of the simulation's thread in an 11 v 11 inside the host, which plays from 2 s on: robots that wait for their kick-off cost little."""
    host = subprocess.Popen([BIN / "sparkhost", "--config", "soccer.lua", "--set", "team=Red Blue", "--set", "Soccer.AutomaticKickOff=true",
                             "--set", "Soccer.WaitBeforeKickOff=2", "--rate", "max", "--duration", str(seconds), "--web-port", "0", "--agent-port", "0",
                             "--monitor-port", "0", "--log-level", "error", *arguments],
                            stdout=subprocess.DEVNULL)
    spent = 0
    while host.poll() is None:
        with contextlib.suppress(OSError, IndexError):
            fields = Path(f"/proc/{host.pid}/task/{host.pid}/stat").read_text().rsplit(")", 1)[1].split()
            spent = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        time.sleep(0.01)
    return spent


def cost(pairs=11, seconds=20):
    """What a recording costs the simulation's thread, in pairs, in turns."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "match.mcap"
        ratios = []
        for _ in range(pairs):
            plain = cpu_of_simulation([], seconds)
            ratios.append(cpu_of_simulation(["--record", file], seconds) / plain)
        size = file.stat().st_size / seconds / 1000
    middle = sorted(ratios)[pairs // 2]
    return (f"CPU time of the simulation's thread with a recording, 11 v 11 humanoids, {pairs} pairs: {middle:.3f} x, at most 1.03 "
            f"({', '.join(f'{r:.3f}' for r in ratios)}); {size:.1f} kB/s, at most 60"), PASS if middle <= 1.03 and size <= 60 else FAIL


POINTS = {
    "1": ("what decides a match is in a hash; each class goes on from its saved state", lambda: tests("contract", "state.*", "core-tree", "lua", "golden", "system-reproducible")),
    "2": ("one match in all ways, dense", lambda: matches("dense")),
    "3": ("the same, dense with exactReplay", lambda: matches("dense with exactReplay")),
    "4": ("the same, articulated", lambda: matches("articulated")),
    "5": ("recordings: simulated again to the last bit, read by others, cut off, damaged; in the browser", lambda: tests("recorder", "system-recording", "recording-mcap", "browser-rewind", "browser-recording-drop")),
    "6": ("snapshots: 3000 cycles go on as if not interrupted; ten minutes of 11 v 11 over TCP, recorded", snapshots),
    "7": ("what a recording costs", cost),
}
