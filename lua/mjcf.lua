-- A model in MJCF, URDF or Webots' language on the ground: by default a standing Booster T1. An agent may drive it.
--
--     sparkhost --config mjcf.lua
--     sparkhost --config mjcf.lua --set model=rsg/robots/k1.xml
--     sparkhost --config mjcf.lua --set model=rsg/robots/rover.wbt --set stiffness=0
--     sparkhost --config mjcf.lua --scene-path ~/models --set model=humanoid.xml --set stiffness=0
include "robots.lua"

robotWorld{ what = "The model file", model = "rsg/robots/t1.xml", engine = "MujocoEngine", stiffness = 200.0 }
