#!/usr/bin/env python3
# row: 24
# input: an agent outside soccer gets numbers
# right: with the digits that are read back as the same number; soccer keeps two decimals
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403


AGENT = """
include "house.lua"
files() scene() physics() simulation()
agents{ port = 0 }
control()
local parser = get("/sys/server/gamecontrol/parser")
for _, number in ipairs{ 0.1, 1 / 3, -2.5e-7, 123456789.123, 1e300, 0.02 } do
  local text = parser:write{ { "x", number } }
  local seen = tonumber(text:match("%(x ([^)]*)%)"))
  print((seen == number and "right: " or "wrong: ") .. text)
end
"""
SOCCER = """include "soccer-sphere.lua"
local text = get("/sys/server/gamecontrol/parser"):write{ { "x", 1 / 3 } }
print((text == "(x 0.33)" and "right: " or "wrong: ") .. text)
"""
with Folder() as folder:
    (folder / "agent.lua").write_text(AGENT)
    (folder / "match.lua").write_text(SOCCER)
    for config in ("agent.lua", "match.lua"):
        done = run("sparkhost", "--config", config, "--rate", "max", "--duration", "0.02", "--agent-port", "0",
                   *(["--monitor-port", "0", "--web-port", "0"] if config == "match.lua" else []), cwd=folder)
        judge(f"{config} runs", done.returncode == 0, done.stderr)
        print(
            "".join(
                line[line.index(verdict) :] + "\n"
                for line in done.stderr.splitlines()
                for verdict in ("right: ", "wrong: ")
                if verdict in line
            ),
            end="",
        )
    judge("all numbers were seen", done.returncode == 0)
