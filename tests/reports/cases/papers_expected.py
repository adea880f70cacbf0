#!/usr/bin/env python3
# row: p66
# input: --expect waits for the agent of a buggy, which a rule makes, so that the agent names no robot; it answers what it hears
# right: the first message brings the agent to the start, and it drives
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from client import Client, Host, judge

with Host("--config", "buggy.lua", "--set", "drivers=0", "--sync", "--expect", "1") as host:
    agent = Client(host.ports["agentPort"])
    first = agent.receive()
    judge(f"it hears {first} before the start", first.startswith("(time (now 0"))
    heard = []
    for _ in range(30):
        agent.send("(lb 500)(rb 500)(syn)")
        heard.append(agent.receive())
    judge("then it has a robot that senses", all("(LDR (n scan)" in message for message in heard))
    judge("and drives", heard[0].split("(LDR")[1] != heard[-1].split("(LDR")[1])
    ended = host.end()
    judge("the run ends well", ended["faults"] == 0)
