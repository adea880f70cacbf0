#!/usr/bin/env python3
# row: p95
# input: a rule whose handlers run on another host judges actions and requests: it grants, fails, takes too long, and its
#    answer comes too late
# right: each request has one answer; without a verdict it is refused, and so is the action
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from mounts import *  # noqa: E402,F403
from programs import *  # noqa: E402,F403

SERVED = """
get("/sys/server/simulation").rate = "%s"
get("/sys/server/remote").expect = 1
get("/sys/server/remote").patience = 0.0001
plugin "sensors" plugin "effectors"
local control = agents{ port = 0 }
control.requests = true
local count = new("Transform", "/usr/scene/count")      -- pushes that acted, requests granted and refused
control:new("ScriptAspect", "rule"):on("agentConnected", function(self, event)
  get(event.data):new("TimePerceptor", "time")
  get(event.data):new("ScriptEffector", "push"):on("perform", function()
    local n = count.localPos
    count.localPos = { n[1] + 1, n[2], n[3] }
  end)
end)
local asked = 0
new("ScriptBehavior", "/usr/agent/mind"):on("think", function(self, event)
  local n = count.localPos
  for _, p in ipairs(event.data) do
    if p[1] == "granted" then n[2] = n[2] + 1 end
    if p[1] == "refused" then n[3] = n[3] + 1 end
  end
  count.localPos = n
  self.actions = ""
  if event.cycle > 5 and asked < 5 then
    asked = asked + 1
    self.actions = "(push)(request (perceptor TimePerceptor) (name n" .. asked .. "))"
  end
end)
"""
MOUNTED = """
local verdict = ({
  grants = function() end,
  fails = function() error("it fails") end,
  endless = function() while true do end end,
  late = function() for i = 1, 3000000 do end end,
})["%s"]
local rule = mount{ "/usr/a", address = there.address, of = "/sys/server/gamecontrol" }:find("rule")
rule:on("request", verdict)
rule:on("action", function(_, event) if event.data[2][1] == "push" then return verdict() end end)
local count, goes = there:find("count"), "%s" == "grants"
on("rule", function(_, event)
  local n = count.localPos
  if n[2] + n[3] < 5 then return end
  judge(("%s: %%g pushes, %%g granted, %%g refused"):format(n[1], n[2], n[3]),
    (goes and n[1] == 5 and n[2] == 5) or (not goes and n[1] == 0 and n[3] == 5))
  get("/sys/server/simulation"):stop()
end)
"""
for mode, rate in ("grants", "max"), ("fails", "max"), ("endless", "max"), ("late", "real"):
    with Folder() as folder, Served(folder, SERVED % rate) as served:
        with Mounted(folder, served, MOUNTED % (mode, mode, mode), "--rate", rate, "--duration", "600") as host:
            list(host.lines())
        said = served.stop()[1].count("counts as a fault")
        judge(f"{mode}: the log says {int(mode != 'grants')} times why, it is {said}", said == (mode != "grants"))
