#!/usr/bin/env python3
# row: B5
# input: a host that has the token removes servers, and what is below and above them, while an agent is connected
# right: it is refused, the agent is served, and what is not of servers can be removed
"""One agent of a sphere match, and one remote host."""
import struct
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import host, judge  # noqa: E402
import wire  # noqa: E402

TARGETS = [
    "sys/server/net/agents/framing",
    "sys/server/net/agents",
    "sys/server/net",
    "sys/server/gamecontrol/parser",
    "sys/server",
    "sys",
    "sys/server/simulation",
    "sys/server/physics/engine",
]


def main():
    with host(
        "--config",
        "soccer-sphere.lua",
        "--agent-port",
        "0",
        "--monitor-port",
        "0",
        "--web-port",
        "0",
        "--set",
        "remoteAddress=127.0.0.1:0",
        "--set",
        "remoteToken=0123456789abcdef",
        "--rate",
        "real",
    ) as h:
        ports = h.first_line()
        remote = wire.connect(int(h.wait_for(r"mount this one at 127\.0\.0\.1:(\d+)")[1]))
        agent = wire.connect(ports["agentPort"])
        scene = b"(scene rsg/agent/sphere.rsg)"
        agent.sendall(struct.pack(">I", len(scene)) + scene)
        wire.receive(agent)
        remote.sendall(wire.message("hello", 1, "0123456789abcdef", "guest", "/"))
        refused = []
        for number, path in enumerate(TARGETS + ["usr/scene/mark"], 1):
            if path.startswith("usr"):
                remote.sendall(wire.message("call", 1000, "usr/scene", "createChild", ["Transform", "mark"]))
            remote.sendall(wire.message("call", number, path, "unlinkLeaf", []))
            while True:
                body = wire.receive(remote)
                if (
                    body.startswith((wire.value(["ok", number])[:8],))
                    and wire.value(number) in body[:56]
                    and (b"ok" in body[:40] or b"error" in body[:40])
                ):
                    break
            refused.append(b"error" in body[:40] and b"servers stay" in body)
        judge(all(refused[:-1]), f"refused: {sum(refused[:-1])} of {len(TARGETS)}")
        wire.receive(agent)
        wire.receive(agent)
        judge(h.process.poll() is None, "the agent is served")


main()
