#!/usr/bin/env python3
# row: p94
# input: agents that the host starts cannot be made, as their effector has no class; others end before their first thought
# right: the run counts faults, and the log says that all agents are lost; agents that can be made are none of it
import os
import subprocess
import tempfile
from pathlib import Path

BIN = Path(os.environ["SPARKBIN"])
CONFIG = """
include "house.lua"
files() scene() simulation()
plugin "effectors"
spades{ effector = option{ name = "effector", default = "CreateEffector", doc = "Of the agents." }, types = "one", players = 2 }
"""
DATABASE = """<agentdb><agent_type_external name="one"><inputfd>3</inputfd> <outputfd>4</outputfd> <timer>fixed 3</timer>
<working_dir>./</working_dir><exec_line>%s</exec_line></agent_type_external></agentdb>"""
AGENT = """#!/usr/bin/env python3
import os, struct
def read(n):
    data = b""
    while len(data) < n:
        more = os.read(3, n - len(data))
        if not more:
            raise SystemExit
        data += more
    return data
while True:
    message = read(struct.unpack(">I", read(4))[0])
    answer = b"I" if message[:1] == b"D" else b"D"
    os.write(4, struct.pack(">I", 1) + answer)
    if message[:1] == b"X":
        break
"""


def run(program, effector):
    """(faults, log) of a short run."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "config.lua").write_text(CONFIG)
        (folder / "agentdb.xml").write_text(DATABASE % program)
        (folder / "agent.py").write_text(AGENT)
        (folder / "agent.py").chmod(0o755)
        done = subprocess.run([BIN / "sparkhost", "--config", "config.lua", "--rate", "max", "--duration", "0.5", "--set", "agentDatabase=agentdb.xml",
                               "--set", f"effector={effector}"], cwd=folder, capture_output=True, text=True)
        faults = int(done.stdout.partition('"faults":')[2].partition(",")[0] or -1)
        return faults, done.stderr


for what, program, effector, lost in (("agents without a class of their effector", "agent.py", "NoSuchEffector", True),
                                      ("programs that end at once", "true", "CreateEffector", True), ("agents that play", "agent.py", "CreateEffector", False)):
    faults, log = run(program, effector)
    good = (faults > 0) == lost and ("all agents are lost" in log) == lost
    print(f"{'right' if good else 'wrong'}: {what}: {faults} faults")
    if not good:
        print(log)
