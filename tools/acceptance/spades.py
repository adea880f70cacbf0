"""Points of the milestone `spades`: agents in simulated time."""
import json
import subprocess
import tempfile
import time
from pathlib import Path

from .common import BIN, FAIL, OPEN, PASS, build, say, tests

SECONDS = 600  # of a match
BUSY = 2       # processes beside it


def play(timer, seconds=SECONDS, players=11, words="", busy=0):
    """A match of the league of 2004, agents in C; (result, wall time [s])."""
    with tempfile.TemporaryDirectory() as folder:
        types = "".join(f"<agent_type_external name='{name.lower()}'><timer>{timer}</timer><working_dir>{BIN}</working_dir>"
                        f"<exec_line>spades-agent {name} {words}</exec_line></agent_type_external>" for name in ("Red", "Blue"))
        database = Path(folder) / "agentdb.xml"
        database.write_text(f"<agentdb>{types}</agentdb>")
        others = [subprocess.Popen(["sh", "-c", "while :; do :; done"], start_new_session=True) for _ in range(busy)]
        try:
            start = time.monotonic()
            done = subprocess.run(
                [BIN / "sparkhost", "--config", "soccer-2004.lua", "--set", f"agentDatabase={database}", "--set", "agents=red blue", "--set",
                 f"players={players}", "--rate", "max", "--duration", str(seconds), "--seed", "3", "--set", "web=false", "--monitor-port", "0",
                 "--log-level", "error"], stdout=subprocess.PIPE, text=True, check=True)
            wall = time.monotonic() - start
        finally:
            for process in others:
                process.kill()
                process.wait()
    return json.loads(done.stdout.splitlines()[-1]), wall


def one_hash():
    build("release", "spades-agent")
    say(f"A match of {SECONDS} s, idle and beside {BUSY} busy processes")
    results = [play("fixed 3")[0], play("fixed 3", busy=BUSY)[0], play("fixed 3")[0]]
    hashes = sorted({r["stateHash"] for r in results})
    fine = len(hashes) == 1 and all(r["agentsSeen"] == 22 and r["faults"] == 0 for r in results)
    score = results[0]["score"]
    return f"{SECONDS} s, 22 agents, {score[0]}:{score[1]}: idle, busy, idle: {', '.join(hashes)}; agents on other machines are not built yet", OPEN if fine else FAIL


def overlap():
    """22 agents that think 10 ms each take at most 0.6 x the time of one after the other."""
    build("release", "spades-agent")
    seconds, think = 20, 10
    say("22 agents that compute for 10 ms each")
    result, wall = play("fixed 3", seconds=seconds, words=f"burn {think}")
    quick, idle = play("fixed 3", seconds=seconds)
    one_by_one = 22 * (seconds / 0.2) * think / 1000
    ratio = (wall - idle) / one_by_one
    return (f"{seconds} s in {wall:.1f} s, without the thoughts {idle:.1f} s; one after the other they take {one_by_one:.1f} s: {ratio:.2f} x, at most 0.6; "
            f"{'same hash' if result['stateHash'] == quick['stateHash'] else 'other hash'}"), PASS if ratio <= 0.6 and result["stateHash"] == quick["stateHash"] else FAIL


POINTS = {
    "1": ("a ten-minute match of the league of 2004: one hash", one_hash),
    "2": ("messages, misbehaviour, the recorded conversation", lambda: tests("spades", "spades-captures", "system-spades")),
    "4": ("agents think at the same time as one another", overlap),
}
