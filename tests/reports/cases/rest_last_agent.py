# row: 24
# input: two agents play in a run without a duration, and leave; the config ends it with its last agent, as a page says
# right: it goes on with one, and ends without any
import re
import signal
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
from client import PATIENCE, Client, Host, judge  # noqa: E402

PAGE = Path(__file__).resolve().parents[3] / "docs/drive-your-robot.md"
LINE = re.search(r"last agent \|.*then `(.*?)`", PAGE.read_text())[1]
CONFIG = f"""include "house.lua"
files() scene() physics() simulation()
local agents = agents{{}}
monitors{{}} web()
{LINE}
agents:new("ScriptAspect", "hear"):on("agentConnected", function(self, event)
  get(event.data):new("ScriptPerceptor", "count"):on("perceive", function() return agents.agentCount end)
end)
"""

with tempfile.TemporaryDirectory() as folder:
    config = Path(folder) / "config.lua"
    config.write_text(CONFIG)
    with Host("--config", str(config)) as host:
        first, second = Client(host.ports["agentPort"]), Client(host.ports["agentPort"])
        for client in (first, second):
            client.send("(syn)")
        while "(count 2)" not in second.receive():
            pass
        first.close()
        while "(count 1)" not in second.receive():
            pass
        judge("it goes on with one agent", host.process.poll() is None)
        second.close()
        signal.alarm(PATIENCE)  # if it does not end
        judge(f"it ends without agents, exit code {host.process.wait()}", host.process.returncode == 0)
