-- row: 8
-- input: elements and attributes that URDF does not have, in every kind of element
-- right: each is named with its place
-- args: --duration 0.1
-- expect: unheard_of.urdf:1:1: the attribute 'colour' of <robot> is not supported
-- expect: unheard_of.urdf:2:3: the element <planet> is not supported
-- expect: unheard_of.urdf:3:3: the attribute 'flavour' of <link> is not supported
-- expect: unheard_of.urdf:4:15: the attribute 'unit' of <mass> is not supported
-- expect: unheard_of.urdf:4:100: the element <halo> is not supported
-- expect: unheard_of.urdf:5:23: the attribute 'rounded' of <box> is not supported
-- expect: unheard_of.urdf:5:56: the element <glow> is not supported
-- expect: unheard_of.urdf:5:74: the element <sticker> is not supported
-- expect: unheard_of.urdf:8:72: the attribute 'speed' of <axis> is not supported
-- expect: unheard_of.urdf:8:101: the element <gearbox> is not supported
-- expect: unheard_of.urdf:9:25: the element <aura> is not supported
include "../lib/urdf.lua"
urdfRobot("urdf/unheard_of.urdf", 1)
