-- row: 12
-- input: fields of Webots devices that have no effect here
-- right: each is named; with strict the world is refused
-- args: --duration 0.1
-- expect: the field 'lens' of Camera is not supported
-- expect: the field 'antiAliasing' of Camera is not supported
-- expect: a Lidar that rotates senses its whole field of view at once
-- expect: the field 'defaultFrequency' of Lidar is not supported
-- expect: the responses of the lookupTable of a DistanceSensor are ignored
-- expect: the field 'redColorSensitivity' of DistanceSensor is not supported
-- expect: the field 'speedNoise' of GPS is not supported
include "../lib/judge.lua"
include "house.lua"
files() scene() physics() simulation() agents{ port = 0 }
plugin "sensors" plugin "effectors"
local place = new("Transform", "/usr/scene/space/place")
place:importScene("sense_ignored.wbt")
get("/sys/server/scene/webots").strict = true
local ok = pcall(function() place:importScene("sense_ignored.wbt", "q-") end)
judge("it is refused with strict", not ok)
