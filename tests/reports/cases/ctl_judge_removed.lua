-- row: p83
-- input: judges of actions and requests that fail or take too long; then their handlers are removed, replaced, or end
--    with the node of the script that made them
-- right: while such a handler is there all is refused; when it is removed the refusal is over, and a new one decides
-- args: --duration 1.4 --agent-port 0
-- exit: 0
-- expect: It is switched off
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
local post = new("Transform", "/usr/scene/post")
local rule = control:new("ScriptAspect", "rule")
rule:on("agentConnected", function(self, event)
  get(event.data):new("TimePerceptor", "time")
  get(event.data):new("ScriptEffector", "push"):on("perform", function() acted[mode] = true end)
end)
acted, mode = {}, ""
local answers, handlers = {}, {}
local function guard(verdict)
  local function action(_, event) if event.data[2][1] == "push" then return verdict() end end
  handlers = { rule:on("request", verdict), rule:on("action", action) }
end
local function unguard() for _, handler in ipairs(handlers) do handler:remove() end handlers = {} end
local function fails() error("it fails") end
local function endless() while true do end end
local function no() return "no" end
local stages = { -- name, what happens before, granted
  { "at_first", function() end, true },
  { "fails", function() guard(fails) end, false },
  { "fails_still", function() end, false },
  { "failing_removed", unguard, true },
  { "endless", function() guard(endless) end, false },
  { "switched_off", function() end, false },
  { "off_removed", unguard, true },
  { "off_again", function() guard(endless) end, false },
  { "off_replaced", function() unguard() guard(function() end) end, true },
  { "of_a_script", function() unguard() post:attachScript("../lib/refuses.lua", rule) end, false },
  { "of_a_script_still", function() end, false },
  { "script_deleted", function() post:delete() end, true },
  { "a_no", function() unguard() guard(no) end, false },
  { "two_one_fails", function() guard(fails) end, false },
  { "two_removed", unguard, false }, -- the one that says no is still there
}
local asks = new("ScriptBehavior", "/usr/agent/asks")
asks:on("think", function(self, event)
  for _, p in ipairs(event.data) do if p[1] == "granted" or p[1] == "refused" then answers[p[2][2]] = p[1] end end
  local stage = stages[event.cycle // 4]
  self.actions = ""
  mode = stage and stage[1] or ""
  if stage and event.cycle % 4 == 0 then stage[2]() end
  if stage and event.cycle % 4 == 1 then
    self.actions = "(push)(request (perceptor TimePerceptor) (name " .. mode .. "))"
  end
end)
on("rule", function(self, event)
  if event.cycle ~= 68 then return end
  for _, s in ipairs(stages) do
    local answer = answers[s[1]] or "not answered"
    judge(s[1] .. ": the action " .. (acted[s[1]] and "acts" or "does not act"), (acted[s[1]] == true) == s[3])
    judge(s[1] .. ": the request is " .. answer, answer == (s[3] and "granted" or "refused"))
  end
end)
