-- row: 24
-- input: worlds of Webots with every kind of thing that is left out or changed, on an engine that is not MuJoCo
-- right: nothing is named in the language of MuJoCo
-- args: --duration 0.1 --set engine=OdeEngine
-- expect: flawed.wbt
-- never: Mujoco
-- never: MuJoCo
-- never: equality
-- never: condim
-- never: solref
-- never: <geom
include "../lib/judge.lua"
include "../lib/webots.lua"
webotsCase()
for _, name in ipairs { "flawed", "slide", "rack", "valley", "corner", "old" } do
  judge(name .. " loads", imports("webots/" .. name .. ".wbt"))
end
judge("devices load", imports "sense_devices.wbt")
