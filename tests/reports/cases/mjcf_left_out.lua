-- row: 8
-- input: a crate with meshes that are missing, flat or unknown, bad sizes, and sensors, actuators, pairs and ties of
--   nothing
-- right: each is named with its place and left out; the crate loads, rests on its good geom, and its arm has a mass
-- engines: all
-- expect: mjcf_left_out.xml:6:5: <mesh> 'torn' is left out: expected 12 to
-- expect: mjcf_left_out.xml:12:7: <geom> 'top' is left out: mjcf_left_out.xml:3:5: cannot read the mesh
--   'nowhere/lid.stl'
-- expect: mjcf_left_out.xml:13:7: a <geom> adds no mass to its body: its mesh is flat
-- expect: mjcf_left_out.xml:13:7: a <geom> is left out: a flat mesh has no convex hull
-- expect: mjcf_left_out.xml:14:7: <geom> 'spots' is left out: mjcf_left_out.xml:5:5: the mesh has no convex hull
-- expect: mjcf_left_out.xml:15:7: <geom> 'rag' is left out: there is no <mesh> 'torn'
-- expect: mjcf_left_out.xml:16:7: <geom> 'none' is left out: there is no <mesh> 'unheard'
-- expect: mjcf_left_out.xml:17:7: <geom> 'thin' is left out: the 'size' of a box needs 3 lengths above 0
-- expect: mjcf_left_out.xml:18:7: <geom> 'cone' is left out: expected plane or hfield or sphere
-- expect: mjcf_left_out.xml:19:7: <geom> 'slick' is left out: expected 1, 3, 4 or 6 for 'condim', found 2
-- expect: mjcf_left_out.xml:20:7: <site> 'mark' is left out: expected 3 numbers for 'pos' of <site>, found '0 0 nan'
-- expect: mjcf_left_out.xml:21:7: a <body> that moves and has no mass gets 10 g
-- expect: mjcf_left_out.xml:28:5: a <pair> of the unsupported geom 'top' is not supported
-- expect: mjcf_left_out.xml:29:5: <pair> is left out: there is no geom 'nothing'
-- expect: mjcf_left_out.xml:30:5: <exclude> is left out: there is no body 'nothing'
-- expect: mjcf_left_out.xml:33:5: <weld> 'glue' is left out: there is no body 'nothing'
-- expect: mjcf_left_out.xml:34:5: <connect> 'pin' is left out: expected an attribute 'anchor'
-- expect: mjcf_left_out.xml:35:5: <tendon> 'tied' is left out: there is no tendon 'rope'
-- expect: mjcf_left_out.xml:38:5: <spatial> 'rope' is left out: mjcf_left_out.xml:38:26: there is no site 'mark'
-- expect: mjcf_left_out.xml:39:5: <fixed> 'wire' is left out: expected a lower and a higher number for 'range'
-- expect: mjcf_left_out.xml:42:5: <motor> 'lift' is left out: there is no joint 'nothing' to act on
-- expect: mjcf_left_out.xml:43:5: <motor> 'pull' acts on a tendon that is left out
-- expect: mjcf_left_out.xml:44:5: <motor> 'bend' is left out: expected a lower and a higher number for 'ctrlrange'
-- expect: mjcf_left_out.xml:47:5: <gyro> 'spin' is left out: there is no site 'mark'
-- expect: mjcf_left_out.xml:48:5: <jointpos> 'angle' is left out: there is no joint 'nothing'
-- expect: mjcf_left_out.xml:49:5: <framepos> 'where' is left out: there is no body 'nothing'
-- never: no effect in MuJoCo
include "../lib/judge.lua"
include "../lib/urdf.lua"
local crate = urdfRobot("mjcf_left_out.xml", 0)
near("the crate's mass", crate:find("box/body").mass, 4, 1e-9)
near("the arm's mass", crate:find("arm/body").mass, 0.01, 1e-9)
nearAt(1.8, "the crate's height", function() return crate:find("box/body").position[3] end, 0.2, 0.01)
