-- row: 13
-- input: a robot that falls and tumbles is put back and stopped, before the step, after it, and by its transform
-- right: its accelerometers say what they say in free fall, 0, in each cycle
-- engines: all
-- args: --duration 2
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics(engineOption()) simulation() agents{ port = 0 }
plugin "sensors"
local robot = new("Transform", "/usr/scene/robot")
robot.localPos = { 0, 0, 50 }
local body = robot:new("RigidBody", "body")
body:setBoxTotal(5, 0.3, 0.3, 0.3)
body.angularVelocity = { 0, 0, 3 }
local agent = robot:new("AgentAspect", "agent")
agent:new("Accelerometer", "middle")
local side = agent:new("Transform", "side")
side.localPos = { 0.1, 0, 0 }
side:new("Accelerometer", "side")
local function stop()
  body.velocity = { 0, 0, 0 }
  body.angularVelocity = { 0, 0, 0 }
end
local function resets(name, first, act) on(name, function(_, event) if isAt(event.time, first) then act() end end) end
resets("prepare", 0.4, function() body:setPosition(0, 0, 50) stop() end)
resets("rule", 0.8, function() stop() body:setPosition(1, 2, 50) end)
resets("rule", 1.2, function() robot.localPos = { 0, 0, 50 } stop() body.velocity = { 3, 0, 0 } end)
local worst, samples = 0, 0
watch(agent, function(seen, time)
  if time < 0.1 then return end
  samples = samples + 1
  for _, name in ipairs{ "middle", time > 0.5 and "side" or "middle" } do
    local a = seen["ACC " .. name][3]
    for i = 2, 4 do worst = math.max(worst, math.abs(a[i])) end
  end
  if isAt(time, 1.9) then
    near("the largest acceleration of " .. samples .. " samples", worst, 0, 0.05)
  end
end)
