-- row: 8
-- input: a crate with shapes of no size, meshes that are missing or flat, an unknown shape, bad numbers, and parts of
--   nothing
-- right: each is named with its place and left out; the crate loads and rests on its good collider
-- engines: all
-- expect: crate.urdf:8:23: a <visual> is left out: expected a length above 0 for 'radius' of <sphere>, found '0'
-- expect: crate.urdf:9:59: there is no material 'tin' with a colour: it is grey
-- expect: crate.urdf:11:26: a <collision> is left out: expected three lengths above 0 for 'size' of <box>, found '0
--   0 0'
-- expect: crate.urdf:12:26: a <collision> is left out: expected a length above 0 for 'length' of <cylinder>, found '-1'
-- expect: crate.urdf:13:26: a <collision> is left out: cannot read the mesh 'package://nowhere/lid.stl'
-- expect: a <collision> is left out: a flat mesh has no convex hull, and collides only where it does not move
-- expect: crate.urdf:15:26: the element <cone> is not supported
-- expect: crate.urdf:16:5: a <collision> is left out: expected an element <geometry> in <collision>
-- expect: crate.urdf:19:3: a revolute joint without <limit> has no limits
-- expect: crate.urdf:20:45: the attribute 'xyz' of <origin> is ignored: expected 3 numbers, found '0 0 nan'
-- expect: crate.urdf:20:68: an axis of length 0 counts as '1 0 0'
-- expect: crate.urdf:20:87: the <mimic> of the joint 'hinge' is left out: there is no joint 'nothing'
-- expect: crate.urdf:22:3: the link 'lost' is left out: it does not hang on the root link 'box'
-- expect: crate.urdf:23:30: the <transmission> 'drive' is left out: there is no joint 'nothing'
-- expect: crate.urdf:24:3: <gazebo> is ignored: there is no link or joint 'nothing'
include "../lib/judge.lua"
include "../lib/urdf.lua"
local crate = urdfRobot("urdf/crate/crate.urdf", 0.3)
nearAt(1.8, "the crate's height", function() return crate:find("box/body").position[3] end, 0.2, 0.01)
