-- row: 8
-- input: a mesh of another machine's folder, in capitals, mirrored
-- right: the file of that name around the robot is read, which is said; the block rests on it
-- engines: all
-- expect: block.urdf:4:26: the mesh 'file:///home/maker/robots/parts/meshes/BLOCK.obj' is not there:
--   'urdf/parts/meshes/Block.obj' is read in its place
include "../lib/judge.lua"
include "../lib/urdf.lua"
local block = urdfRobot("urdf/crate/block.urdf", 0.35)
nearAt(1.8, "the block's height", function() return block:find("block/body").position[3] end, 0.3, 0.01)
