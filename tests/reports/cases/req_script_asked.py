#!/usr/bin/env python3
# row: pF9
# input: a robot has perceptors in Lua, which count in locals and in their state, draw random numbers and move a node;
#    its mind and a rule ask them again and again, or do not
# right: it perceives the same in each cycle; the answers are what it perceived last
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

DRAWN = """
on("perceive", function(self)
  state.n = (state.n or 0) + 1
  return { n = state.n, r = math.random() }
end)
"""
CONFIG = """
include "house.lua"
files() scene() physics() simulation() plugin "sensors" plugin "modifiers"
local ask = option{ name = "ask", default = false, doc = "Whether perceptors are asked." }
agents{ port = 0 }
local function words(list)
  local out = {}
  for _, v in ipairs(list) do out[#out + 1] = type(v) == "table" and "(" .. words(v) .. ")" or tostring(v) end
  return table.concat(out, " ")
end
local post = new("Transform", "/usr/scene/post")
local thing = new("Transform", "/usr/scene/thing")
local a = thing:new("AgentAspect", "agent")
local n = 0
local count = a:new("ScriptPerceptor", "count")
count:on("perceive", function(self, event)
  n = n + 1
  post.localPos = { n, 0, 0 }
  return { n = n, cycle = event.cycle }
end)
local third = a:new("ScriptPerceptor", "third")
third.interval = 3
third:on("perceive", function() return { x = post.localPos[1], r = math.random() } end)
local drawn = a:new("ScriptPerceptor", "drawn")
drawn:script("drawn.lua")
drawn:new("WhiteNoise", "noise").sigma = 0.1
a:new("TimePerceptor", "time"):new("Delay", "late").cycles = 3
local answers, wrong = 0, 0
a:new("ScriptBehavior", "mind"):on("think", function(self, event)
  local heard = words(event.data)
  print("heard " .. heard)
  if not ask then return end
  local answer = words(count:sense())
  answers = answers + 1
  if not heard:find(answer, 1, true) then wrong = wrong + 1 end
  for i = 1, 3 do a:sense() drawn:sense() end
end)
on("rule", function(self, event)
  if ask then a:sense() third:sense() end
  if event.cycle == 20 and ask then print("asked " .. answers .. " times, " .. wrong .. " wrong") end
end)
"""
with Folder() as folder:
    (folder / "drawn.lua").write_text(DRAWN)
    (folder / "asks.lua").write_text(CONFIG)
    logs = []
    for ask in ("false", "true"):
        done = run("sparkhost", "--config", folder / "asks.lua", "--rate", "max", "--duration", "0.5", "--set",
                   f"ask={ask}")
        judge(f"ask={ask}: it runs", done.returncode == 0, done.stderr)
        logs.append(done.stderr)
    heard = [[line[line.index("heard "):] for line in log.splitlines() if "heard " in line] for log in logs]
    judge("it has perceived", len(heard[0]) > 20 and "drawn" in heard[0][5] and "third" in "".join(heard[0]), heard[0])
    judge("with questions it perceives the same", heard[0] == heard[1], f"{heard[0][:4]} {heard[1][:4]}")
    judge("the answers are what it perceived last", "times, 0 wrong" in logs[1] and "asked 1" in logs[1], logs[1])
