-- row: 7
-- input: height fields written in the model, flat, of a file that is missing, and on a body that moves
-- right: a marble comes to rest at the bottom of the bowl, a crate on the plain; the others are named and left out
-- engines: all
-- args: --duration 4
-- expect: mjcf_hills.xml:11:5: <geom> 'lost' is left out: mjcf_hills.xml:6:5: cannot read the heights 'nowhere.png'
-- expect: mjcf_hills.xml:23:7: a <geom> is left out: a height field collides only where it does not move
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mjcf_hills.xml")
local function at(name) return get("/usr/scene/hills/" .. name .. "/body").position end
atTime(3.9, function()
  local marble, crate = at "marble", at "crate"
  judge("the marble is in the bowl, at " .. marble[1] .. " " .. marble[2],
        math.abs(marble[1]) < 0.6 and math.abs(marble[2]) < 0.6)
  judge("it is on the ground, at " .. marble[3], marble[3] > 1.15 and marble[3] < 1.45)
  near("the crate's height", crate[3], 0.65, 0.01)
  near("the crate's place", crate[1], 6.3, 0.02)
end)
