#!/usr/bin/env python3
# row: p95
# input: mounts without an address, without a path, at ports where nothing listens, of nodes that are not there, twice
#    at one place; and a remote rule with two handlers, of which the first refuses
# right: each error is a sentence, the node of a mount that failed is gone, a second attempt works and can be simulated
#    again; the refusal counts
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import *  # noqa: E402,F403
from programs import *  # noqa: E402,F403

SERVED = """
get("/sys/server/simulation").rate = "max"
get("/sys/server/remote").expect = 1
plugin "effectors"
local control = agents{ port = 0 }
control:new("ScriptAspect", "rule"):on("agentConnected", function(self, event)
  get(event.data):new("TimePerceptor", "time")
  get(event.data):new("ScriptEffector", "push"):on("perform", function()
    get("/usr/scene/heard").localPos = { 9, 0, 0 }
  end)
end)
new("Transform", "/usr/scene/heard")
new("ScriptBehavior", "/usr/agent/mind"):on("think", function(self) self.actions = "(push)" end)
"""
MOUNTED = """
local address = there.address
local function why(what, t, expected)
  local good, text = pcall(function() mount(t) end)
  judge(what .. ": " .. tostring(text):sub(1, 120), not good and tostring(text):find(expected, 1, true))
  judge(what .. ": no node stays", type(t) ~= "table" or not t[1] or not get(t[1]))
end
why("nothing", {}, "expected the path of the new node first")
why("no address", { "/usr/a" }, "expected an address, host:port or a Unix socket, found nil")
why("no text", { "/usr/a", address = 7 }, "found 7")
why("no host", { "/usr/a", address = "127.0.0.1:1" }, "cannot reach a host at 127.0.0.1:1")
why("no port", { "/usr/a", address = "nonsense" }, "nonsense")
why("no such node", { "/usr/a", address = address, of = "/usr/nowhere" }, "there is no node /usr/nowhere")
local rule = mount{ "/usr/a", address = address, of = "/sys/server/gamecontrol" }:find("rule")
local asked = { 0, 0 }
for i = 1, 2 do
  rule:on("action", function(_, event)
    asked[i] = asked[i] + 1
    if i == 1 then return "not now" end
  end)
end
on("rule", function(_, event)
  if asked[2] < 10 then return end
  judge("both are asked", asked[1] >= asked[2])
  judge("one refuses, and nothing is done", there:find("heard").localPos[1] == 0)
  get("/sys/server/simulation"):stop()
end)
"""
with Folder() as folder, Served(folder, SERVED) as served:
    mounted(folder, served, MOUNTED, "--duration", "600", "--record", folder / "run.mcap")
    code, again, log = verify(folder / "run.mcap")
    judge("the recording is simulated again", code == 0 and again.get("differs", "") is None, f"{code} {again} {log}")
