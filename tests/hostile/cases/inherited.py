#!/usr/bin/env python3
# row: A2
# input: the host starts an agent that lists its descriptors, and leaves a child behind; the host is killed, and another one takes its ports
# right: the agent has 0 to 4 and nothing of the host, and the ports are free
"""A host with all its servers; its agent is a script."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
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
open(sys.argv[1] + '.child', 'w').write(str(child))
seen = [fd + ' ' + os.readlink('/proc/self/fd/' + fd) for fd in os.listdir('/proc/self/fd') if os.path.exists('/proc/self/fd/' + fd)]
open(sys.argv[1] + '.part', 'w').write('\\n'.join(seen))
os.rename(sys.argv[1] + '.part', sys.argv[1])
while (head := os.read(3, 4)):
    said = os.read(3, struct.unpack('>I', head)[0])
    answer = {b'D': b'I', b'S': b'D', b'T': b'D', b'K': b'D'}.get(said[:1])
    if answer:
        os.write(4, struct.pack('>I', 1) + answer)
"""
DATABASE = """<agentdb><agent_type_external name="one"><timer>fixed 1</timer><working_dir>{folder}</working_dir>
<exec_line>agent.py {folder}/seen</exec_line></agent_type_external></agentdb>"""
CONFIG = """include "soccer-2004.lua"
logs()
"""


CHILDREN = []  # what the agent of the first host has left


def start(folder, ports):
    """A host, and its first line."""
    (folder / "host.lua").write_text(CONFIG)
    host = subprocess.Popen(
        [os.environ["SPARKBIN"] + "/sparkhost", "--config", folder / "host.lua", "--set", "agents=one", "--set", "players=1",
         "--set", f"agentDatabase={folder}/db.xml", "--set", "commPort=0", "--set", "remoteAddress=127.0.0.1:0",
         "--monitor-port", str(ports.get("monitorPort", 0)),
         "--web-port", ports.get("web", ":0").strip("/").split(":")[-1], "--set", f"logFile={folder}/log.txt", "--record", folder / f"{len(ports)}.mcap",
         "--rate", "real", "--log-level", "error"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    line = host.stdout.readline()
    if not line:
        print("wrong: the host ended: " + host.stderr.read())
        sys.exit(1)
    return host, json.loads(line)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "agent.py").write_text(AGENT)
        (folder / "agent.py").chmod(0o755)
        (folder / "db.xml").write_text(DATABASE.format(folder=folder))
        host, ports = start(folder, {})
        try:
            while not (folder / "seen").exists():
                if host.poll() is not None:
                    print("wrong: the host ended: " + host.stderr.read())
                    return
                time.sleep(0.02)
            more = [line for line in (folder / "seen").read_text().splitlines() if int(line.split()[0]) > 4 and "/proc/" not in line]
            print(f"{'wrong' if more else 'right'}: beside 0 to 4 the agent has {more or 'nothing'}")
        finally:
            host.send_signal(signal.SIGKILL)
            host.wait()
            CHILDREN.append(int((folder / "seen.child").read_text()))
        second, again = start(folder, ports)
        same = all(again[k] == ports[k] for k in ("monitorPort", "web"))
        print(f"{'right' if same else 'wrong'}: another host has the ports {again}")
        second.terminate()
        second.wait()
        for pid in CHILDREN:
            os.kill(pid, signal.SIGKILL)


main()
