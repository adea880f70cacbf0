-- row: 13
-- input: a free bar is turned by a torque without gravity; an accelerometer is at its end
-- right: it feels the tangential acceleration at once
-- engines: all
-- args: --duration 0.5
include "../lib/judge.lua"
include "../lib/senses.lua"
local body, agent = freeBar()
on("prepare", function() body:addTorque(0, 0, 1.5) end)  -- 3 rad/s^2
watch(agent, function(seen, time)
  if isAt(time, 0.1) then near("the tangential acceleration", seen["ACC tip"][3][3], 2.4, 0.05) end
end)
