-- row: 1
-- input: two crates rest on a shelf, in gravity that leans; the surfaces lose their friction at 4 s
-- right: they slide
-- engines: OdeEngine ArticulatedEngine BulletEngine
-- args: --duration 6.5
include "../lib/judge.lua"
include "../lib/shelf.lua"
local place, lower, upper = shelf()
get("/usr/scene/world").gravity = { 0, 1.5, -9.81 }
local before
at(4, function()
  before = upper.position[2]
  near("the place at rest", before, 0, 0.05)
  for _, surface in ipairs{ place:find("board/surface"), get("/usr/scene/space/lower/box/surface") } do
    surface.contactPyramid = true
    surface.contactMu = 0
  end
end)
at(4.6, function()
  judge("the upper crate slid by " .. upper.position[2] - before, upper.position[2] - before > 0.1)
end)
