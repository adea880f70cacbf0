#!/usr/bin/env python3
# row: B2
# input: peers that do a little just before each limit of time, again and again: a byte of a message, of a request, of
#   a greeting, an action without a robot, a picture that is read in drips
# right: each is closed at its limit, and one that does all at once is served all the while
import base64
import os
import select
import socket
import struct
import sys
import threading
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import host, judge  # noqa: E402
import wire  # noqa: E402

PAUSE = 0.05  # s between drips, a tenth of the limits
LONG = 600  # drips: what no limit ends goes on for half a minute and more
TOKEN = "0123456789abcdef"
CONFIG = """include "house.lua"
files() scene() physics()
agents{ port = 0 } monitors{ port = 0 } web()
simulation() remote()
-- Two thousand things that never stand still: of such a picture no system's buffers hold half a minute.
for i = 1, 2000 do
  local place = new("Transform", "/usr/scene/t" .. i)
  place.localPos = { i % 50, i // 50, 100 }
  local body = place:new("RigidBody", "body")
  body:setSphereTotal(1, 0.1)
  place:new("Sphere", "look")
end
"""
OTHER = """include "house.lua"
files() scene() physics()
spades{ types = "", players = 0 }
simulation()
"""
SETTINGS = ("/sys/server/net/agents.messageTimeout", "/sys/server/gamecontrol.idleLimit",
            "/sys/server/web.requestTimeout", "/sys/server/web.stallTimeout")


def framed(text):
    return struct.pack(">I", len(text)) + text.encode()


def drip(port, parts, first=b""):
    """How many of the parts were sent until the peer closed; None if it took them all."""
    with wire.connect(port) as client:
        client.sendall(first)
        client.settimeout(PAUSE)
        for count, part in enumerate(parts):
            try:
                client.sendall(part)
                while True:
                    if not client.recv(4096):
                        return count
            except socket.timeout:
                continue
            except OSError:
                return count
    return None


def bytes_of(data):
    return (data[i:i + 1] for i in range(LONG))


def reads_in_drips(port):
    """A viewer that reads a few bytes at a time of what it has asked for."""
    with socket.socket() as client:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        client.connect(("127.0.0.1", port))
        key = base64.b64encode(os.urandom(16)).decode()
        client.sendall(
            f"GET /stream HTTP/1.1\r\nHost: localhost:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n".encode()
        )
        request = b'{"do":"view","rate":50}'
        client.sendall(bytes([0x81, 0x80 | len(request), 0, 0, 0, 0]) + request)
        end = select.poll()
        end.register(client, 0)  # of errors and the end it tells unasked
        client.settimeout(PAUSE)
        for count in range(LONG):
            if end.poll(1000 * PAUSE):
                return count
            try:
                if not client.recv(16):
                    return count
            except socket.timeout:
                continue
            except OSError:
                return count
    return None


def main():
    limits = [part for s in SETTINGS for part in ("--set", s + "=0.5")]
    other = host("--set", "commPort=0", "--set", "commServers=1", config=OTHER)
    with other, host("--set", "webPort=0", "--set",
                     "remoteAddress=127.0.0.1:0", "--set", "remoteToken=" + TOKEN, "--rate", "real", *limits,
                     config=CONFIG) as h:
        ports = {**other.first_line(), **h.first_line()}
        web = int(ports["web"].rsplit(":", 1)[1].split("/")[0])
        remote = int(h.wait_for(r"mount this one at 127\.0\.0\.1:(\d+)")[1])
        hello = wire.message("hello", 1, TOKEN, "guest" * 500, "/usr")
        request = "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + "y" * LONG
        attacks = {
            "a message of an agent": lambda: drip(ports["agentPort"], bytes_of(framed("x" * LONG))),
            "actions of an agent without a robot": lambda: drip(ports["agentPort"], [framed("(he1 0)")] * LONG),
            "a request for a page": lambda: drip(web, bytes_of(request.encode())),
            "the greeting of a communication server": lambda: drip(ports["commPort"], bytes_of(framed("W" * LONG))),
            "the greeting of a remote host": lambda: drip(remote, bytes_of(hello)),
            "a viewer's picture": lambda: reads_in_drips(web),
        }
        found = {}
        threads = [threading.Thread(target=lambda k=k, a=a: found.update({k: a()})) for k, a in attacks.items()]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for kind in attacks:
            count = found[kind]
            judge(count is not None, f"{kind}: " + ("is read for ever" if count is None else "closed"))
        judge("was closed: you do not read what you are sent" in h.text(), "the viewer's reason is in the log")
        with wire.connect(remote) as client:
            client.sendall(hello)
            judge(b"welcome" in wire.receive(client), "a remote host that says it all at once is served")
        judge(h.process.poll() is None, "the host lives")


main()
