#!/usr/bin/env python3
# row: C8
# input: another program connects to the port at which the host waits for an agent that it has started, before that does
# right: it is refused, and the agent plays
import os
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import host, judge  # noqa: E402
import wire  # noqa: E402

# The agent says where the host waits for it, and comes when it may. A child of it connects, as scripts do that start
# an agent.
AGENT = """#!/usr/bin/env python3
import socket, struct, subprocess, sys
if len(sys.argv) == 3:
    open('port', 'w').write(sys.argv[1] + '\\n')
    open('go').read()
    sys.exit(subprocess.call([sys.argv[0], *sys.argv[1:], 'child']))
host = socket.create_connection(('127.0.0.1', int(sys.argv[1])))
def say(text):
    host.sendall(struct.pack('>I', len(text)) + text)
say(b'(scene rsg/agent/sphere_2004.rsg)(syn)')
say(b'(init (unum 1)(teamname Own))(syn)')
while host.recv(65536):
    say(b'(syn)')
"""
DATABASE = """<agentdb><agent_type_external name="one"><protocol>tcp</protocol><timer>fixed 1</timer>
<exec_line>agent.py {port} {number}</exec_line></agent_type_external></agentdb>"""
CONFIG = """include "soccer-2004.lua"
"""


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "agent.py").write_text(AGENT)
        (folder / "agent.py").chmod(0o755)
        (folder / "db.xml").write_text(DATABASE)
        for pipe in ("port", "go"):
            os.mkfifo(folder / pipe)
        with host("--set", "agents=one", "--set", "players=1", "--set", f"agentDatabase={folder}/db.xml",
                  "--set", "createEffector=SceneEffector", "--monitor-port", "0", "--web-port", "0",
                  "--rate", "max", "--log-level", "info", config=CONFIG) as h:
            port = int((folder / "port").read_text())
            stranger = wire.connect(port)
            stranger.sendall(b"\0\0\0\x2e(scene rsg/agent/sphere_2004.rsg)(syn)")
            try:
                refused = stranger.recv(1) == b""
            except ConnectionError:
                refused = True
            judge(refused, "the stranger is refused")
            (folder / "go").write_text("")
            judge(h.wait_for("has its robot|is lost") and "has its robot" in h.text(), "the agent has its robot")


main()
