-- A robot in URDF on the ground: by default a small arm. An agent may drive it.
--
--     sparkhost --config urdf.lua --sync --rate max
--     sparkhost --config urdf.lua --scene-path ~/robots --set model=dog_description/urdf/dog.urdf --set height=0.4
include "robots.lua"

robotWorld{ what = "The URDF file", model = "rsg/robots/arm.urdf", engine = "MujocoEngine", stiffness = 0.0 }
