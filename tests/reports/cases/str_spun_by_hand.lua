-- row: 13
-- input: the spin of a free bar is set by hand before a step, after it, and twice in a cycle; an accelerometer is at
--   its end
-- right: it feels what its place does with that spin, and nothing of the change
-- engines: all
-- args: --duration 1
include "../lib/judge.lua"
include "../lib/senses.lua"
local body, agent = freeBar()
local spin = 0
local function spun(phase, at, to)
  on(phase, function(_, event)
    if not isAt(event.time, at) then return end
    body.angularVelocity = { 0, 0, -to }
    body.angularVelocity = { 0, 0, to }
    spin = to
  end)
end
spun("act", 0.2, 3)
spun("rule", 0.4, -2)
spun("prepare", 0.6, 4)
local before, across, along, samples = 0, 0, 0, 0
watch(agent, function(seen, time)
  local a = seen["ACC tip"][3]
  -- In the cycle of the change the percept may still be of the spin before.
  if before == spin then
    along = math.max(along, math.abs(a[2] + 0.8 * spin * spin))
    samples = samples + 1
  end
  across = math.max(across, math.abs(a[3]))
  before = spin
  if isAt(time, 0.9) then
    judge(string.format("%d samples were of a known spin", samples), samples > 35)
    near("the largest acceleration along its way", across, 0, 0.05)
    near("the largest error of that to the centre", along, 0, 0.05)
  end
end)
