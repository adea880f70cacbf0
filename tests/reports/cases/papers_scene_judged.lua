-- row: p83
-- input: a rule lists nothing, a file, or classes, and agents load robots and ask for files with other sensors
-- right: what is not listed is refused, nothing of it stays, and it counts for the tolerance
-- args: --duration 0.6 --agent-port 0
-- expect: Agent 1 gets no robot: the rules do not allow rsg/agent/papers_bare.rsg
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
local rule = control:new("RequestAspect", "rule")
rule.tolerance = 0
local listener = control:new("ScriptAspect", "listener")
local asked = {}
listener:on("request", function(self, event) asked[#asked + 1] = table.concat(event.data, " ", 2) end)

local function file(name) return "(scene rsg/agent/papers_" .. name .. ".rsg)" end
local parts, seer, bare = { "GPS", "ForceEffector" }, "rsg/agent/papers_seer.rsg", "rsg/agent/papers_bare.rsg"
local steps = {
  { allowed = {}, ask = file "bare", granted = false, what = "nothing is listed: no robot" },
  { allowed = { "GPS" }, ask = file "cart", granted = false, what = "an effector is not listed" },
  { allowed = parts, ask = file "cart", granted = true, what = "all parts are listed" },
  { allowed = parts, ask = file "seer", granted = false, what = "the eye is not listed" },
  { allowed = { seer }, ask = file "seer", granted = true, what = "the file is listed" },
  { allowed = { bare }, ask = file "bare" .. "(request " .. file "seer" .. ")", granted = false,
    what = "a file for the robot has an eye" },
}
local made = {}
local first = 2
on("rule", function(self, event)
  local i = (event.cycle - first) // 4 + 1
  if event.cycle >= first and (event.cycle - first) % 4 == 0 and steps[i] then
    rule.allowed = steps[i].allowed
    new("ScriptBehavior", "/usr/agent/a" .. i):on("start", function(self) self.actions = steps[i].ask end)
  end
end)
listener:on("agentConnected", function(self, event) made[#made + 1] = event.data end)
local left = {}
listener:on("agentLeaving", function(self, event) left[event.data] = true end)
on("rule", function(self, event)
  if event.cycle ~= 28 then return end
  for i, step in ipairs(steps) do
    judge(step.what .. (step.granted and ": granted" or ": disqualified"),
      made[i] and step.granted == not left[made[i]])
  end
  local all = table.concat(asked, "; ")
  judge("a rule in Lua hears of files and their parts: " .. all:sub(1, 120),
    all:find("scene rsg/agent/papers_bare.rsg", 1, true) == 1 and all:find("scene rsg/agent/papers_cart.rsg", 1, true)
    and all:find("effector ForceEffector legs rsg/agent/papers_cart.rsg", 1, true))
end)
