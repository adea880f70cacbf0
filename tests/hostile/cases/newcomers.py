#!/usr/bin/env python3
# row: B2
# input: 64 silent connections at the ports of communication servers and of remote hosts, which come again at once
# right: one that speaks is served
"""The match has no agents: its port for communication servers waits for one."""
import selectors
import socket
import sys
import threading
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import Program, host, judge  # noqa: E402
import wire  # noqa: E402

DATABASE = """<agentdb><agent_type_external name="one"><timer>fixed 1</timer><exec_line>true</exec_line>
</agent_type_external></agentdb>"""
CONFIG = """include "house.lua"
files() scene() physics()
spades{ types = "", players = 0 }
simulation() remote()
"""


class Silent(threading.Thread):
    """Connections that say nothing; each that is closed comes again."""

    def __init__(self, port, count=64):
        super().__init__(daemon=True)
        self.port, self.selector, self.over = port, selectors.DefaultSelector(), False
        for _ in range(count):
            self.come()

    def come(self):
        self.selector.register(wire.connect(self.port), selectors.EVENT_READ)

    def run(self):
        while not self.over:
            for key, _ in self.selector.select(0.05):
                try:
                    ended = not key.fileobj.recv(4096)
                except OSError:
                    ended = True
                if ended and not self.over:
                    self.selector.unregister(key.fileobj)
                    key.fileobj.close()
                    self.come()


def main():
    with host("--set", "commPort=0", "--set", "commServers=1", "--set", "remoteAddress=127.0.0.1:0",
              "--set", "remoteToken=0123456789abcdef", "--rate", "real", config=CONFIG) as h:
        ports = h.first_line()
        remote = int(h.wait_for(r"mount this one at 127\.0\.0\.1:(\d+)")[1])
        crowds = [Silent(ports["commPort"]), Silent(remote)]
        for crowd in crowds:
            crowd.start()
        database = Path(h.process.args[2]).parent / "agents.xml"
        database.write_text(DATABASE)
        with Program("sparkcomm", "--port", ports["commPort"], "--database", database, "--patience", "20") as comm:
            # If it ends without being served, the host ends too, and with it the waiting.
            served = threading.Event()
            threading.Thread(target=lambda: (comm.process.wait(), served.is_set() or h.end()), daemon=True).start()
            found = h.wait_for("is there")
            served.set()
            judge(found, "a communication server is " + ("there" if found else "not served"))
            client = wire.connect(remote)
            client.sendall(wire.message("hello", 1, "0123456789abcdef", "guest", "/usr"))
            try:
                answer = wire.receive(client)
            except OSError as e:
                answer = str(e).encode()
            judge(b"welcome" in answer, f"a remote host is answered {answer[32:48]}")
        for crowd in crowds:
            crowd.over = True
        judge(h.process.poll() is None, "the host lives")


main()
