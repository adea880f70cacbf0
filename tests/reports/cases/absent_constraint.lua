-- row: 8
-- input: a body that a constraint of MuJoCo names is removed while the simulation runs
-- right: the log says that the constraint has no effect
-- engines: MujocoEngine
-- args: --duration 0.2
-- expect: /usr/scene/absent/pin: no effect in MuJoCo
include "house.lua"
files() scene() physics(engineOption()) simulation()
get("/usr/scene"):importScene("absent.xml")
on("rule", function(_, event)
  if event.cycle == 3 then get("/usr/scene/absent/stone"):delete() end
end)
