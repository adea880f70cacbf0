-- row: 8
-- input: a world of R2021b, in which y is up, with a post that falls on the ground
-- right: it stands on the ground, along z
-- args: --duration 3
-- engines: all
include "../lib/judge.lua"
include "../lib/webots.lua"
webotsCase()
judge("the world is read", imports("webots/old.wbt", true))
local post = all(get "/usr/scene/post", "RigidBody")[1]
on("rule", function(_, event)
  if math.abs(event.time - 2.5) < 0.001 then
    near("its place to the east", post.position[1], 0.5, 0.01)
    near("its place to the north", post.position[2], 1, 0.01)
    near("the height of its centre", post.position[3], 0.5, 0.01)
  end
end)
