#!/usr/bin/env python3
# row: p64
# input: an agent that speaks JSON sends texts that look like numbers, and numbers, to a script that sends them back
# right: a text stays a text and a number a number, in both directions, with `binary` and without
import json
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
from client import Client, Host, judge  # noqa: E402

CONFIG = """
include "house.lua"
files() scene() physics() simulation() monitors{} web()
local agents = agents{}
plugin "parser-json"
plugin "effectors"
agentPort("json", 0, "JsonParser")
local parser = get("/sys/server/net/json/parser")
parser.binary = option{ name = "binary", default = false }
parser.decimals = -1
local last = {}
agents:new("ScriptAspect", "post"):on("agentConnected", function(_, event)
  local robot = get(event.data)
  robot:new("ScriptEffector", "echo"):on("perform", function(_, action)
    local value = action.data[2]
    last = { "echo", value, math.type(value) or type(value) }
  end)
  robot:new("ScriptPerceptor", "heard"):on("perceive", function() return { last } end)
  robot:new("AgentSyncEffector", "syn")
end)
"""
TEXTS = ["5", "-5", "007", "1e5", "1.50", "0x10", "nan", "inf", "-inf", "", " ", "5 ", "true", "null", "[1]", ")(syn)",
         '"', "\\", "\t", "word", "9" * 400]
NUMBERS = [5, -5, 0, 1.5, -0.25, 1e300, 2**53 + 1, True]
SYN = '["syn"]'

with tempfile.TemporaryDirectory() as folder:
    config = Path(folder) / "config.lua"
    config.write_text(CONFIG)
    for binary in ("false", "true"):
        with Host("--config", str(config), "--rate", "max", "--sync", "--set", f"binary={binary}") as host:
            agent = Client(int(re.search(r"Port json: listening on .*:(\d+)\.", host.log())[1]))
            agent.send(SYN)
            agent.receive()
            wrong = []
            for value in TEXTS + NUMBERS:
                agent.send(json.dumps([["echo", value], ["syn"]]))
                for _ in range(3):  # the action, and what comes of it
                    answer = json.loads(agent.receive())
                    agent.send(SYN)
                back = next(p[1][1:] for p in answer if p[0] == "heard")
                agent.receive()
                kind = {str: "string", bool: "string", float: "float", int: "integer"}[type(value)]
                if back != ["true" if value is True else value, kind]:
                    wrong.append((value, back))
            judge(f"{len(TEXTS)} texts and {len(NUMBERS)} numbers with binary={binary}: {wrong[:5]}", not wrong)
