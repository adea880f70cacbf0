-- row: 1
-- input: two crates rest on a shelf; another engine takes over at 4 s, and then the shelf is removed
-- right: they fall to the ground
-- engines: all
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
local place, lower, upper = shelf()
at(3.5, function()
  for _, name in ipairs{ "engine", "collision" } do
    local node = get("/sys/server/physics/" .. name)
    if node then node:delete() end
  end
  new("OdeCollision", "/sys/server/physics/collision")
  new("OdeEngine", "/sys/server/physics/engine")
end)
at(4, function()
  near("the height at rest", lower.position[3], 2.25, 0.02)
  place:delete()
end)
at(6, function()
  near("the height of the lower crate", lower.position[3], 0.2, 0.02)
  near("the height of the upper crate", upper.position[3], 0.6, 0.02)
end)
