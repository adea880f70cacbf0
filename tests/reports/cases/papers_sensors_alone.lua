-- row: p42
-- input: plugin "sensors" without plugin "physics": an agent sees things that a script moves
-- right: it runs and senses; no engine is there
-- args: --duration 0.4 --agent-port 0 --monitor-port 0
include "house.lua" include "../lib/judge.lua"
files() scene() simulation() agents{} monitors{} plugin "sensors"
local cloud = new("Transform", "/usr/scene/cloud")
on("rule", function(self, event) cloud.localPos = { event.cycle, 0, 1 } end)
local a = new("Transform", "/usr/scene/watcher"):new("AgentAspect", "agent")
a:new("PerfectVisionPerceptor", "all")
a:new("GPS", "gps")
local x, gps = 0, false
a:new("ScriptBehavior", "mind"):on("think", function(self, event)
  for _, p in ipairs(event.data) do
    if p[1] == "GPS" then gps = true end
    for i = 2, #p do if p[i][1] == "cloud" then x = p[i][2][2] end end
  end
end)
on("rule", function(self, event)
  if event.cycle ~= 18 then return end
  judge("it sees the cloud move: " .. x, x > 10)
  judge("it knows its place", gps)
  judge("there is no engine", not get("/sys/server/physics"))
  local made, why = pcall(function() return new("TouchPerceptorHandler", "/usr/scene/watcher/touch") end)
  judge("what needs physics says so: " .. tostring(why):sub(1, 300),
        not made and why:find("needs its base class", 1, true))
end)
-- what asks classes of their kind meets those whose bases are not there
judge("classes answer",
      get("/classes/GPS"):isA("Perceptor") and get("/classes/TouchPerceptorHandler"):isA("ContactJointHandler") and
      not get("/classes/RigidBody"))
judge("a wrong property is the only error",
      not select(2, pcall(function() return get("/plugins/physics").loaded end)):find("needs its base", 1, true))
