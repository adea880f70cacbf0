-- row: 8
-- input: transmissions whose joint has no name, without a joint, of a joint that does not move, and a second one of the
--   same joint; then with strict
-- right: each is named with its place and left out, the others drive their joints; with strict it is an error
-- args: --duration 0.1
-- expect: last_transmission.urdf:9:33: the <transmission> 'nameless' is left out: expected an attribute 'name' of <joint>
-- expect: last_transmission.urdf:10:3: the <transmission> 'empty' is left out: expected an element <joint>
-- expect: last_transmission.urdf:11:31: the <transmission> 'stiff' is left out: the joint 'weld' is none of one axis
-- expect: last_transmission.urdf:12:31: the <transmission> 'again' is left out: the joint 'hinge' has one already
include "../lib/judge.lua"
include "house.lua"
files() scene() physics() simulation() agents{}
local place = new("Transform", "/usr/scene/space/place")
place:importScene("last_transmission.urdf")
judge("the robot is there", #place:children() == 1)
get("/sys/server/scene/urdf").strict = true
local other = new("Transform", "/usr/scene/space/other")
local ok, why = pcall(function() other:importScene("last_transmission.urdf") end)
judge("with strict it is an error", not ok and tostring(why):find("is left out", 1, true) ~= nil)
