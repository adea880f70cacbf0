#!/usr/bin/env python3
# row: pF3
# input: sparkctl makes a node in a running host, attaches a script to it, runs a line, lists agents and disqualifies one
# right: all act in the run; a script that is wrong, runs forever or deletes a server is an error, and the host goes on
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

BIN = Path(os.environ["SPARKBIN"])
CONFIG = """
include "house.lua"
files() scene() simulation() agents{} control() plugin "sensors"
new("Transform", "/usr/scene/o"):new("AgentAspect", "agent"):new("ScriptBehavior", "mind"):on("think", function() end)
"""
SCRIPT = """
on("rule", function() self.localPos = { self.localPos[1] + 1, 0, 0 } end)
return "attached to " .. tostring(self)
"""


def judge(what, good):
    print(f"{'right' if good else 'wrong'}: {what}")


with tempfile.TemporaryDirectory() as folder:
    folder = Path(folder)
    environment = {**os.environ, "XDG_RUNTIME_DIR": str(folder)}
    (folder / "config.lua").write_text(CONFIG)
    (folder / "mover.lua").write_text(SCRIPT)
    host = subprocess.Popen([BIN / "sparkhost", "--config", folder / "config.lua", "--agent-port", "0"], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, env=environment)
    host.stdout.readline()

    def ctl(*words):
        done = subprocess.run([BIN / "sparkctl", "--pid", str(host.pid), "--wait", "20", *map(str, words)], capture_output=True, text=True, env=environment)
        return (done.stdout + done.stderr).strip()

    judge("a node is made", ctl("make", "Transform", "/usr/scene/ball") == "/usr/scene/ball")
    judge("a script is attached, and says something", ctl("attach", "/usr/scene/ball", folder / "mover.lua") == "attached to /usr/scene/ball")
    watch = subprocess.Popen([BIN / "sparkctl", "--pid", str(host.pid), "watch", "/usr/scene/ball.localPos"], stdout=subprocess.PIPE, text=True, env=environment)
    seen = [watch.stdout.readline() for _ in range(3)]
    watch.kill()
    watch.wait()
    judge("its handler moves the node", len(set(seen)) == 3)
    judge("a line runs", ctl("run", "return #get('/usr/scene'):children() + 40") == "42")
    judge("a line runs at a node", ctl("run", "return self.name", "--at", "/usr/scene/ball") == "ball")
    for what, text, why in (("a wrong one", "nothing()", "attempt to call"), ("one without end", "while true do end", "instructions"),
                            ("one that deletes a server", "delete('/sys/server/scene')", "in use"), ("one that opens files", "io.open('x')", "nil")):
        said = ctl("run", text)
        judge(f"{what} is an error: {said[:100]}", said.startswith("sparkctl: ") and why in said)
    judge("agents are listed", "/usr/scene/o/agent" in ctl("call", "/sys/server/gamecontrol.agents"))
    ctl("call", "/sys/server/gamecontrol.disqualify", 1, "from outside")
    ctl("run", "on('rule', function() Left = get('/sys/server/gamecontrol').agentCount == 0 end)")
    judge("the host goes on", ctl("run", "return 1 + 1") == "2")
    host.send_signal(signal.SIGTERM)
    out, log = host.communicate()
    judge("an agent is disqualified from outside", "Agent 1 is disqualified: from outside." in log)
    judge("it ends well", host.returncode == 0 and '"faults":0' in out)
