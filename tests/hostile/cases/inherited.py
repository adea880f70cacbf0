#!/usr/bin/env python3
# row: A2
# input: an agent lists its descriptors and leaves a child behind; the host is killed, and another one takes its ports
# right: the agent has 0 to 4 and nothing of the host, and the ports are free
"""A host with all its servers; its agent is a script."""
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

AGENT = """#!/usr/bin/env python3
import os, struct, sys
child = os.fork()
if child == 0:
    os.setsid()
    import signal
    signal.alarm(60)  # if nothing kills it before
    signal.pause()
    os._exit(0)
fds = '/proc/self/fd/'
seen = [fd + ' ' + os.readlink(fds + fd) for fd in os.listdir(fds) if os.path.exists(fds + fd)]
with open(sys.argv[1], 'w') as pipe:
    pipe.write('\\n'.join([str(child), *seen]) + '\\n.')
while (head := os.read(3, 4)):
    said = os.read(3, struct.unpack('>I', head)[0])
    answer = {b'D': b'I', b'S': b'D', b'T': b'D', b'K': b'D'}.get(said[:1])
    if answer:
        os.write(4, struct.pack('>I', 1) + answer)
"""
DATABASE = """<agentdb><agent_type_external name="one"><timer>fixed 1</timer><working_dir>{folder}</working_dir>
<exec_line>agent.py {folder}/told</exec_line></agent_type_external></agentdb>"""
CONFIG = """include "soccer-2004.lua"
logs()
"""


CHILDREN = []  # what the agent of the first host has left


def start(folder, ports):
    """A host, and its first line."""
    (folder / "host.lua").write_text(CONFIG)
    host = subprocess.Popen(
        [os.environ["SPARKBIN"] + "/sparkhost", "--config", folder / "host.lua",
         "--set", "agents=one", "--set", "players=1",
         "--set", f"agentDatabase={folder}/db.xml", "--set", "commPort=0", "--set", "remoteAddress=127.0.0.1:0",
         "--monitor-port", str(ports.get("monitorPort", 0)),
         "--web-port", ports.get("web", ":0").strip("/").split(":")[-1], "--set", f"logFile={folder}/log.txt",
         "--record", folder / f"{len(ports)}.mcap", "--rate", "real", "--log-level", "error"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    line = host.stdout.readline()
    if not line:
        print("wrong: the host ended: " + host.stderr.read())
        sys.exit(1)
    return host, json.loads(line)


def told(pipe, host):
    """What the agent has written up to a full stop; exits if the host ends before."""
    text = b""
    while not text.endswith(b"\n."):
        ready, _, _ = select.select([pipe, host.stderr], [], [])
        if pipe not in ready:
            print("wrong: the host ended: " + host.stderr.read())
            sys.exit(1)
        text += os.read(pipe, 65536)
    child, *seen = text.decode().splitlines()[:-1]
    CHILDREN.append(int(child))
    return seen


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "agent.py").write_text(AGENT)
        (folder / "agent.py").chmod(0o755)
        (folder / "db.xml").write_text(DATABASE.format(folder=folder))
        os.mkfifo(folder / "told")
        pipe = os.open(folder / "told", os.O_RDWR)
        host, ports = start(folder, {})
        try:
            seen = told(pipe, host)
            more = [line for line in seen if int(line.split()[0]) > 4 and "/proc/" not in line]
            print(f"{'wrong' if more else 'right'}: beside 0 to 4 the agent has {more or 'nothing'}")
        finally:
            host.send_signal(signal.SIGKILL)
            host.wait()
        second, again = start(folder, ports)
        same = all(again[k] == ports[k] for k in ("monitorPort", "web"))
        print(f"{'right' if same else 'wrong'}: another host has the ports {again}")
        second.terminate()
        second.wait()
        for pid in CHILDREN:
            os.kill(pid, signal.SIGKILL)


main()
