# row: 25
# input: in lockstep a client answers every message with (syn); in most cycles the robot that a rule made for it has no
#   percepts: its one perceptor returns nil, or has an interval
# right: it is not waited for in a cycle without a message, and gets all the others until the run ends
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
from client import Client, Host, judge  # noqa: E402

CONFIG = """include "house.lua"
files() scene() physics() simulation() monitors{} web()
local mode = option{name="mode", default="nil"}
local agents = agents{}
agents.expect = 1
plugin "effectors"
agents:new("ScriptAspect", "post"):on("agentConnected", function(self, event)
  local robot = get(event.data)
  robot:new("AgentSyncEffector", "syn")
  local count = robot:new("ScriptPerceptor", "count")
  count:on("perceive", function(_, e) if mode == "interval" or e.cycle % 5 == 0 then return e.cycle end end)
  if mode == "interval" then count.interval = 5 end
end)
"""

with tempfile.TemporaryDirectory() as folder:
    config = Path(folder) / "config.lua"
    config.write_text(CONFIG)
    for mode in ("nil", "interval"):
        options = ["--set", f"mode={mode}", "--sync", "--rate", "max", "--duration", "1"]
        with Host("--config", str(config), *options) as host:
            client, messages = Client(host.ports["agentPort"]), []
            client.socket.settimeout(20)
            try:
                client.send("(syn)")
                while True:
                    messages.append(client.receive())
                    client.send("(syn)")
            except OSError as end:
                ended = "" if not isinstance(end, TimeoutError) else ", and then waited in vain"
            except EOFError:
                ended = ""
            cycles = [int(n) for n in re.findall(r"\(count (\d+)\)", " ".join(messages))]
            steps = {b - a for a, b in zip(cycles, cycles[1:])}
            seen = f"{mode}: {len(cycles)} messages, steps of {sorted(steps)} cycles{ended}"
            judge(seen, len(cycles) >= 9 and steps == {5} and not ended)
