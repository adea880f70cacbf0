-- row: 2
-- input: three bodies that MuJoCo finds too light, later a fourth one, and then an older one that becomes light
-- right: the log names the first, and the later ones; all fall
-- engines: MujocoEngine
-- args: --duration 0.5
-- expect: /usr/scene/crumb1/body (and 2 more): its mass [kg] or moments of inertia [kg m^2] are taken as 2e-15
-- expect: /usr/scene/crumb4/body: its mass [kg] or moments of inertia [kg m^2] are taken as 2e-15
-- expect: /usr/scene/stone/body: its mass [kg] or moments of inertia [kg m^2] are taken as 2e-15
include "../lib/judge.lua"
include "../lib/mesh.lua"
include "../lib/crate.lua"
meshWorld()
for i, mass in ipairs { 1e-14, 3e-15, 1e-15 } do crate("crumb" .. i, i, 5, mass) end
local stone = crate("stone", 0, 5)
atTime(0.2, function() crate("crumb4", 4, 5, 1e-15) end)
atTime(0.3, function() stone:setMassParameters(1e-15, { 0, 0, 0 }, { 1e-17, 1e-17, 1e-17 }, { 0, 0, 0 }) end)
atTime(0.4, function()
  near("the height of the stone", stone.position[3], 4.2, 0.01)
  near("the height of the third crumb", get("/usr/scene/crumb3/body").position[3], stone.position[3], 1e-6)
  judge("the late crumb has fallen, too", get("/usr/scene/crumb4/body").position[3] < 4.9)
end)
