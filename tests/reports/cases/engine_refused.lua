-- row: 2
-- input: MuJoCo's compiler takes no body of 2e-15 kg
-- right: the log names the body, and the host lives
-- engines: MujocoEngine
-- args: --duration 0.5
-- expect: MuJoCo does not take this world
-- expect: /usr/scene/feather/body: MuJoCo:
include "../lib/judge.lua"
include "house.lua"
files() scene() physics(engineOption()) simulation()
include "../lib/crate.lua"
local _, stone = crate("stone", 0, 5)
local _, feather = crate("feather", 2, 5, 2e-15)
for _, place in ipairs{ stone, feather } do place:new("BoxCollider", "box"):setBoxLengths(0.4, 0.4, 0.4) end
on("sense", function(_, event)
  if event.cycle == 20 then near("the height of the stone, in a world that stands still", stone.position[3], 5, 0) end
end)
