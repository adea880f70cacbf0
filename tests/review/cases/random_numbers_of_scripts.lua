-- With a seed each script gets its own random numbers, the same in every run and independent of other scripts.
-- expect: first drew 0.700150
-- expect: second drew 0.051372
-- args: --rate max --duration 1 --seed 7
include "house.lua"
files() scene() simulation()
for _, name in ipairs{ "first", "second" } do
  new("Transform", "/usr/scene/" .. name):attachScript("scripts/draws.lua", { name = name })
end
