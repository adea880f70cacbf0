-- row: 8
-- input: a world with a PROTO in Javascript, and one in Lua that it names by an address in the web
-- right: both are there, with what their fields say
-- args: --duration 0.1
include "../lib/judge.lua"
include "../lib/webots.lua"
webotsCase()
judge("the world is read", imports("webots/rack.wbt", true))
local rack, post = get "/usr/scene/rack/rack", get "/usr/scene/post"
local shelves = all(rack, "BoxCollider")
near("the number of shelves", #shelves, 3, 0)
near("the width of the last shelf", shelves[3].boxLengths[1], 0.8, 1e-6)
near("the height of the rack's centre", rack.localPos[3], 0.6, 1e-6)
near("the height of the last shelf over it", rack:find("shape6").localPos[3], 0.4, 1e-6)
near("the mass of the rack", rack:find("body").mass, 6, 1e-9)
near("the number of the post's parts", #all(post, "CylinderCollider"), 2, 0)
near("the height of its last part", post:find("shape4").localPos[3], 0.625, 1e-6)
