#!/usr/bin/env python3
# row: 25
# input: a client joins in lockstep without --expect, message by message: (scene ...), (init ...), (he1 ...), (syn);
#   it thinks before each answer; the host is at nice 10 beside two busy loops
# right: each time it gets the same messages in the same cycles
"""The client answers each message with one. Its first (syn) is in the fifth."""
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

OPENING = [
    "(scene rsg/agent/nao/nao_hetero.rsg 1)",
    "(init (unum 3) (teamname Walkers))",
    "(he1 2)",
    "(he1 -1)(he2 1)",
    "(lae1 -1)(syn)",
]
CYCLES, SESSIONS = 10, 2
THOUGHT = 0.03  # s of the processor
HOST = [
    "--config",
    "soccer.lua",
    "--sync",
    "--rate",
    "max",
    "--agent-port",
    "0",
    "--monitor-port",
    "0",
    "--web-port",
    "0",
    "--log-level",
    "error",
]


def read(client, count):
    data = b""
    while len(data) < count:
        part = client.recv(count - len(data))
        if not part:
            raise EOFError("the host closed the connection")
        data += part
    return data


def think():
    """What a client does before it answers, beside the loops."""
    end = time.process_time() + THOUGHT
    while time.process_time() < end:
        pass


def session(port):
    """The times and the other noise-free percepts of a client's messages."""
    messages = []
    with socket.create_connection(("127.0.0.1", port)) as client:
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for cycle in range(CYCLES):
            said = (OPENING[cycle] if cycle < len(OPENING) else "(syn)").encode()
            client.sendall(struct.pack(">I", len(said)) + said)
            messages.append(read(client, struct.unpack(">I", read(client, 4))[0]).decode())
            if cycle + 1 < len(OPENING):
                think()
    times = [float(re.search(r"\(now ([\d.]+)\)", m)[1]) for m in messages]
    steps = [round((t - times[0]) / 0.02) for t in times]
    return steps, [re.findall(r"\((?:GS|GYR|ACC|HJ|FRP) .*?\)\)", m) for m in messages]


def main():
    # All share one processor, on which the host seldom has its turn.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    programs = []
    try:
        hosts = [
            subprocess.Popen(
                ["nice", "-n", "10", Path(os.environ["SPARKBIN"]) / "sparkhost", *HOST],
                stdout=subprocess.PIPE,
                text=True,
            )
            for _ in range(SESSIONS)
        ]
        programs += hosts
        ports = []
        for host in hosts:
            ports.append(json.loads(host.stdout.readline())["agentPort"])
            host.send_signal(signal.SIGSTOP)
        programs += [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
        sessions = []
        for host, port in zip(hosts, ports):
            host.send_signal(signal.SIGCONT)
            sessions.append(session(port))
            host.kill()
    finally:
        for program in programs:
            program.kill()
            program.wait()
    for number, (steps, percepts) in enumerate(sessions, 1):
        same = percepts == sessions[0][1]
        good = same and steps == list(range(CYCLES))
        seen = f"session {number} has cycles {' '.join(map(str, steps))}"
        print(f"{'right' if good else 'wrong'}: {seen}" + ("" if same else " and other percepts than session 1"))


main()
