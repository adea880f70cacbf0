"""Points of the milestone `spades`: agents in simulated time."""
import json
import re
import subprocess
import tempfile
import time
from pathlib import Path

from .common import BIN, FAIL, PASS, build, say, tests
from .network import Machine, Road

SECONDS = 600  # of a match
BUSY = 2       # processes beside it


class Busy:
    """Processes that do nothing but compute."""

    def __init__(self, count):
        self.count = count

    def __enter__(self):
        self.processes = [subprocess.Popen(["sh", "-c", "while :; do :; done"], start_new_session=True) for _ in range(self.count)]

    def __exit__(self, *unused):
        for process in self.processes:
            process.kill()
            process.wait()


def agent_type(name, timer, arguments):
    return (f"<agent_type_external name='{name}'><timer>{timer}</timer><working_dir>{BIN}</working_dir>"
            f"<exec_line>spades-agent {arguments}</exec_line></agent_type_external>")


def tcp_type(name, timer):
    """A team of spheres that is made for plain TCP."""
    return (f"<agent_type_external name='{name.lower()}'><protocol>tcp</protocol><timer>{timer}</timer><working_dir>{BIN}</working_dir>"
            f"<exec_line>sphere-team --port {{port}} --number {{number}} --team {name} --robot rsg/agent/sphere_2004.rsg</exec_line></agent_type_external>")


TEAMS = ("Red", "Blue")
AGENTS_IN_C = ("".join(agent_type(name.lower(), "fixed 3", name) for name in TEAMS), [])
AGENTS_OVER_TCP = ("".join(tcp_type(name, "fixed 3") for name in TEAMS), ["--set", "createEffector=SceneEffector", "--set", "Soccer.LongNames=false"])


def play(types, arguments=(), seconds=SECONDS, players=11, busy=0):
    """A match of the league of 2004; (result, wall time [s])."""
    with tempfile.TemporaryDirectory() as folder:
        database = Path(folder) / "agentdb.xml"
        database.write_text(f"<agentdb>{types}</agentdb>")
        with Busy(busy):
            start = time.monotonic()
            done = subprocess.run(
                [BIN / "sparkhost", "--config", "soccer-2004.lua", "--set", f"agentDatabase={database}", "--set", "agents=red blue", "--set",
                 f"players={players}", "--rate", "max", "--duration", str(seconds), "--seed", "3", "--set", "web=false", "--monitor-port", "0",
                 "--log-level", "error", *arguments], stdout=subprocess.PIPE, text=True, check=True)
            wall = time.monotonic() - start
    return json.loads(done.stdout.splitlines()[-1]), wall


def play_apart(types, arguments, seconds, **road):
    """The match with the agents of two communication servers on machines of their own; (result, number of cuts)."""
    with tempfile.TemporaryDirectory() as folder, Machine(1) as one, Machine(2) as two:
        database = Path(folder) / "agentdb.xml"
        database.write_text(f"<agentdb>{types}</agentdb>")
        host = subprocess.Popen([BIN / "sparkhost", "--config", "soccer-2004.lua", "--set", "commPort=0", "--set", "commServers=2", "--set",
                                 "agents=red blue", "--rate", "max", "--duration", str(seconds), "--seed", "3", "--set", "web=false",
                                 "--monitor-port", "0", "--log-level", "error", *arguments], stdout=subprocess.PIPE, text=True)
        port = json.loads(host.stdout.readline())["commPort"]
        with Road(one.outer, port, seed=1, **road) as first, Road(two.outer, port, seed=2, **road) as second:
            servers = [machine.start([BIN / "sparkcomm", "--host", way.address, "--port", way.port, "--database", database, "--name", machine.name])
                       for machine, way in ((one, first), (two, second))]
            result = json.loads(host.stdout.readline())
            host.wait()
            for server in servers:
                server.wait(timeout=30)
        return result, first.cuts + second.cuts


def matches(agents):
    """The match in all ways: (text, True if it has one hash)."""
    results = [play(*agents)[0], play(*agents, busy=BUSY)[0]]
    say("The same with agents on two machines; with 50 +- 20 ms and stalls; with cuts")
    results.append(play_apart(*agents, SECONDS)[0])
    results.append(play_apart(*agents, SECONDS, delay=0.025, jitter=0.01, stall=0.5)[0])
    cut, cuts = play_apart(*agents, SECONDS, cut=2_000_000)
    results.append(cut)
    hashes = sorted({r["stateHash"] for r in results})
    score = results[0]["score"]
    return (f"{score[0]}:{score[1]}, {cuts} cuts: {', '.join(hashes)}",
            len(hashes) == 1 and all(r["agentsSeen"] == 22 and r["faults"] == 0 for r in results))


def one_hash():
    build("release", "spades-agent", "sphere-team")
    judged, good = [], True
    for name, agents in (("agents in C", AGENTS_IN_C), ("agents over TCP, through the adapter", AGENTS_OVER_TCP)):
        say(f"A match of {SECONDS} s of {name}, idle and beside {BUSY} busy processes")
        text, one = matches(agents)
        judged.append(f"{name}: {text}")
        good &= one
    return (f"{SECONDS} s, 22 agents; idle, busy, on two machines, there and back 50 +- 20 ms with stalls, cuts; {'; '.join(judged)}"), PASS if good else FAIL


# A world without bodies, which logs in which step each agent acts.
ACTS = """
include "house.lua"
files() scene()
simulation().step = 0.01
spades{ types = "quick slow", players = 1 }
new("ScriptAspect", "/sys/server/gamecontrol/acts"):on("agentConnected", function(self, event)
  local robot = get(event.data)
  for _, word in ipairs{ "create", "init", "drive" } do
    robot:new("ScriptEffector", word):on("perform", function()
      log.info(string.format("acts %s %d", robot.number == 1 and "quick" or "slow", get("/sys/server/simulation").cycle - 1))
    end)
  end
end)
"""


def think_longer():
    """An agent that computes for 30 ms acts three steps later than one that does not, whatever the machine does."""
    build("release", "spades-agent")
    cycles, judged, good = 200, [], True
    for busy in (0, BUSY):
        say(f"{cycles} thoughts of 0 and 30 ms, beside {busy} busy processes")
        with tempfile.TemporaryDirectory() as folder, Busy(busy):
            database, config = Path(folder) / "agentdb.xml", Path(folder) / "acts.lua"
            database.write_text("<agentdb>" + agent_type("quick", "jiffies 10000", "Quick burn 0") + agent_type("slow", "jiffies 10000", "Slow burn 30") + "</agentdb>")
            config.write_text(ACTS)
            done = subprocess.run([BIN / "sparkhost", "--config", config, "--set", f"agentDatabase={database}", "--rate", "max", "--duration",
                                   str(cycles * 0.2 + 1)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=True)
        steps = {"quick": [], "slow": []}
        for who, step in re.findall(r"acts (quick|slow) (\d+)", done.stderr):
            steps[who].append(int(step))
        # Both sense in turns, half an interval apart: agent k of 2 first in step 1 + 10 k.
        later = [slow - quick - 10 for quick, slow in zip(steps["quick"], steps["slow"])]
        three = sum(n == 3 for n in later)
        good &= len(later) >= cycles - 1 and three >= 0.99 * len(later)
        judged.append(f"beside {busy} busy processes {three} of {len(later)}")
    return "three steps later: " + "; ".join(judged) + "; at least 99 of 100", PASS if good else FAIL


def overlap():
    """22 agents that think 10 ms each take at most 0.6 x the time of one after the other."""
    build("release", "spades-agent")
    seconds, think = 20, 10
    say("22 agents that compute for 10 ms each")
    result, wall = play("".join(agent_type(name.lower(), "fixed 3", f"{name} burn {think}") for name in TEAMS), seconds=seconds)
    quick, idle = play(*AGENTS_IN_C, seconds=seconds)
    one_by_one = 22 * (seconds / 0.2) * think / 1000
    ratio = (wall - idle) / one_by_one
    return (f"{seconds} s in {wall:.1f} s, without the thoughts {idle:.1f} s; one after the other they take {one_by_one:.1f} s: {ratio:.2f} x, at most 0.6; "
            f"{'same hash' if result['stateHash'] == quick['stateHash'] else 'other hash'}"), PASS if ratio <= 0.6 and result["stateHash"] == quick["stateHash"] else FAIL


POINTS = {
    "1": ("a ten-minute match of the league of 2004: one hash", one_hash),
    "2": ("messages, misbehaviour, the recorded conversation", lambda: tests("spades", "spades-captures", "system-spades")),
    "3": ("who thinks longer acts later", think_longer),
    "4": ("agents think at the same time as one another", overlap),
}
