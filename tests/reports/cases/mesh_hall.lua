-- row: 7
-- input: four walls of one IndexedFaceSet, with a ball between them that is pushed against one
-- right: the ball falls to the floor, hits the wall and stays within
-- engines: all
-- args: --duration 3
-- never: collides as its convex hull
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mesh_hall.wbt")
local body = get "/usr/scene/ball/ball/body"
local fast = 0
on("rule", function(_, event)
  local v, p = body.velocity, body.position
  fast = math.max(fast, math.sqrt(v[1]^2 + v[2]^2 + v[3]^2))
  if math.abs(event.time - 1) < 0.001 then
    near("height at rest", p[3], 0.12, 0.006)
    near("distance from where it was", math.abs(p[1] - 0.2) + math.abs(p[2] - 0.1), 0, 0.02)
    body.velocity = { 2, 0, 0 }
  end
  if math.abs(event.time - 2.9) < 0.001 then
    judge("it is within, at " .. p[1], math.abs(p[1]) < 1.4 and math.abs(p[2]) < 1.4 and p[3] > 0.1)
    judge("its greatest speed was " .. fast, fast < 4)
  end
end)
