-- A world or a robot of Webots: by default a rover. An agent may drive it.
--
--     sparkhost --config webots.lua --sync --rate max
--     sparkhost --config webots.lua --scene-path ~/webots --set model=projects/robots/x/protos/X.proto
include "robots.lua"

robotWorld{ what = "The world or PROTO file", model = "rsg/robots/rover.wbt", engine = "MujocoEngine", stiffness = 0.0 }
