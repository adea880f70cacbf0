-- row: C7
-- input: an agent requests a camera in each cycle, 32 of them
-- right: four are granted, the others are refused with the reason
-- args: --duration 1.6 --agent-port 0 --web-port 0
include "camera.lua"
include "../../reports/lib/judge.lua"

get("/sys/server/gamecontrol").requests = true
local mind, thoughts, granted, refused = new("ScriptBehavior", "/usr/agent/many"), 0, 0, {}
mind:on("start", function(self) self.actions = "(scene rsg/agent/camera.rsg)" end)
mind:on("think", function(self, event)
  thoughts = thoughts + 1
  self.actions = thoughts > 4 and thoughts <= 36
    and ("(request (perceptor ImagePerceptor) (name eye%d))"):format(thoughts) or ""
  for _, percept in ipairs(event.data) do
    if percept[1] == "granted" then granted = granted + 1 end
    if percept[1] == "refused" then refused[#refused + 1] = percept end
  end
end)
on("rule", function(_, event)
  if event.cycle ~= 70 then return end
  local why = #refused > 0 and table.concat(refused[1][3], " ") or "nothing"
  judge(("%d of 32 were granted, %d refused: %s"):format(granted, #refused, why),
        granted > 0 and granted <= 4 and granted + #refused == 32 and why:find("4 cameras", 1, true))
end)
