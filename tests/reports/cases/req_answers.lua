-- row: p66
-- input: requests that say too little, too much or what cannot be, more than a cycle may have, and some that a rule
--    refuses as actions, limits, or answers with a node of that name
-- right: each has one answer, with the reason, and what has no effect is named
-- args: --duration 0.8 --agent-port 0
include "house.lua" include "../lib/judge.lua"
files() scene() physics() simulation() plugin "sensors" plugin "effectors"
local control = agents{}
control.requests = true
local rule = control:new("ScriptAspect", "rule")
rule:on("agentConnected", function(self, event)
  get(event.data):new("RigidBody", "body"):setSphereTotal(1, 0.1)
  get(event.data):new("TimePerceptor", "time")
end)
rule:on("action", function(self, event) if event.cycle == 20 then return "not in this cycle" end end)
rule:on("request", function(self, event)
  if event.data[4] == "taken" then get(event.data[1]):new("TimePerceptor", "taken") end
end)
local limit = control:new("ActionLimitAspect", "limit")
limit.predicate, limit.perCycle = "request", 12
local function ask(name, more)
  return "(request (perceptor TimePerceptor) (name " .. name .. ")" .. (more or "") .. ")"
end
local function many(n, name)
  local out = {}
  for i = 1, n do out[i] = ask(name .. i) end
  return table.concat(out)
end
local rows = { -- cycle, actions, granted and refused, words that some answer has
  { 6, "(request)", 0, 1, "expected request perceptor" },
  { 7, "(request (perceptor TimePerceptor))", 0, 1, "expected request perceptor" },
  { 8, ask('"two words"'), 0, 1, "blank" },
  { 9, ask("a/b") .. ask("..") .. ask("x[2]") .. ask(".") .. ask('""'), 0, 5, "expected a name without /" },
  { 10, ask("taken"), 0, 1, "a rule has made a node taken there" },
  { 11, ask("coloured", "(colour red) at once"), 1, 0, "unused colour red at once" },
  { 12, "(request (perceptor TimePerceptor) (effector ForceEffector) (name both))", 0, 1, "found more than one" },
  { 13, ask("named", "(name twice)"), 0, 1, "more than once" },
  { 14, ask("placed", "(at)"), 0, 1, "expected request perceptor" },
  { 16, many(11, "m"), 8, 3, "at most 8 requests in a cycle" },
  { 18, many(15, "n"), 8, 7, "the rules allow 12 a cycle" },
  { 20, ask("barred"), 0, 1, "not in this cycle" },
  { 22, "(request (scene nowhere.rsg) (name it))", 0, 1, "unused name it" },
}
local heard = {}
local function words(list)
  local out = {}
  for _, v in ipairs(list) do out[#out + 1] = type(v) == "table" and words(v) or tostring(v) end
  return table.concat(out, " ")
end
new("ScriptBehavior", "/usr/agent/asks"):on("think", function(self, event)
  self.actions = ""
  for _, row in ipairs(rows) do if event.cycle == row[1] - 1 then self.actions = row[2] end end
  local here = { granted = 0, refused = 0, text = "" }
  for _, percept in ipairs(event.data) do
    if here[percept[1]] then
      here[percept[1]] = here[percept[1]] + 1
      here.text = here.text .. "; " .. words(percept)
    end
  end
  heard[event.cycle] = here
end)
on("rule", function(self, event)
  if event.cycle ~= 35 then return end
  for _, row in ipairs(rows) do
    local h = heard[row[1] + 1]
    judge(("cycle %d: %d granted, %d refused%s"):format(row[1], h.granted, h.refused, h.text:sub(1, 120)),
      h.granted == row[3] and h.refused == row[4] and h.text:find(row[5], 1, true))
  end
end)
