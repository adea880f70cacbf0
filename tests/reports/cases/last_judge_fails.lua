-- row: p83
-- input: judges in Lua that fail, take too long, or return what is no text, hear of actions and of requests
-- right: what they judge is refused, each time, and the log says why; a judge that returns nothing grants it
-- args: --duration 1.1 --agent-port 0
-- exit: 0
-- expect: handler of 'action' at /sys/server/gamecontrol/rule failed
-- expect: push: refused: the rule failed, the log says why.
-- expect: its script returned a bool: expected nothing, or a text that says why it refuses
-- expect: It is switched off
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
local modes = { "grants", "fails", "yes", "no", "five", "table", "text", "grants again", "long", "after it" }
local verdicts = {
  fails = function() return nil + 1 end,
  yes = function() return true end,
  no = function() return false end,
  five = function() return 5 end,
  table = function() return {} end,
  text = function() return "not you" end,
  long = function() while true do end end,
}
local mode, acted, granted, refused = "", {}, {}, {}
local rule = control:new("ScriptAspect", "rule")
rule:on("agentConnected", function(self, event)
  local robot = get(event.data)
  robot:new("TimePerceptor", "time")
  robot:new("ScriptEffector", "push"):on("perform", function() acted[mode] = true end)
end)
local function verdict() if verdicts[mode] then return verdicts[mode]() end end
rule:on("action", function(_, event) if event.data[2][1] == "push" then return verdict() end end)
rule:on("request", verdict)
new("ScriptBehavior", "/usr/agent/asks"):on("think", function(self, event)
  for _, percept in ipairs(event.data) do
    if percept[1] == "granted" then granted[percept[2][2]] = true end
    if percept[1] == "refused" then refused[percept[2][2]] = table.concat(percept[3], " ") end
  end
  mode = modes[event.cycle // 4] or ""
  self.actions = "(push)"
  if event.cycle % 4 == 1 and mode ~= "" then
    self.actions = "(push)(request (perceptor GPS) (name " .. mode:gsub(" ", "_") .. "))"
  end
end)
on("rule", function(self, event)
  if event.cycle ~= 50 then return end
  for _, m in ipairs(modes) do
    local name, grants = m:gsub(" ", "_"), m:find("grants") ~= nil
    judge(m .. ": the action " .. (acted[m] and "acts" or "does not act"), (acted[m] == true) == grants)
    judge(m .. ": the request is " .. (granted[name] and "granted" or "refused"), (granted[name] == true) == grants)
    -- from the long one on the action (request ...) is refused, too
    if not grants and not m:find("long") and m ~= "after it" then
      local due = m == "text" and "why not you" or "why the rule failed, the log says why"
      judge(m .. ": the agent is told " .. tostring(refused[name]), refused[name] == due)
    end
  end
end)
