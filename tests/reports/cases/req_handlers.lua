-- row: p83
-- input: rules with two handlers of request and of action, of which one refuses, fails, or takes too long
-- right: all are asked, and one refusal refuses
-- args: --duration 1 --agent-port 0
-- expect: It is switched off
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
local verdicts = {
  { "none", nil, nil, true },
  { "first", function() return "the first says no" end, nil, false },
  { "second", nil, function() return "the second says no" end, false },
  { "both", function() return "the first says no" end, function() return "the second says no" end, false },
  { "fails", function() error("it fails") end, nil, false },
  { "number", function() return 3 end, nil, false },
  { "again", nil, nil, true },
  { "long", function() while true do end end, nil, false },
  { "after", nil, nil, false }, -- the one that took too long is switched off: what it guarded stays refused
}
local now, acted, answers = nil, {}, {}
local rule = control:new("ScriptAspect", "rule")
rule:on("agentConnected", function(self, event)
  get(event.data):new("TimePerceptor", "time")
  get(event.data):new("ScriptEffector", "push"):on("perform", function() if now then acted[now[1]] = true end end)
end)
for i = 2, 3 do
  local function verdict() if now and now[i] then return now[i]() end end
  rule:on("request", verdict)
  rule:on("action", function(self, event) if event.data[2][1] == "push" then return verdict() end end)
end
new("ScriptBehavior", "/usr/agent/asks"):on("think", function(self, event)
  for _, p in ipairs(event.data) do if p[1] == "granted" or p[1] == "refused" then answers[p[2][2]] = p end end
  now = verdicts[event.cycle // 4]
  self.actions = ""
  if now and event.cycle % 4 == 1 then
    self.actions = "(push)(request (perceptor TimePerceptor) (name " .. now[1] .. "))"
  end
end)
on("rule", function(self, event)
  if event.cycle ~= 45 then return end
  for _, v in ipairs(verdicts) do
    local word = answers[v[1]] and answers[v[1]][1] or "not answered"
    judge(v[1] .. ": the action " .. (acted[v[1]] and "acts" or "does not act"), (acted[v[1]] or false) == v[4])
    judge(v[1] .. ": the request is " .. word, word == (v[4] and "granted" or "refused"))
  end
  judge("the first reason is told", answers.both and table.concat(answers.both[3], " ") == "why the first says no")
end)
