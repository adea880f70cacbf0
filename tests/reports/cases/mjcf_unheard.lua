-- row: 8
-- input: elements and attributes that MJCF does not have, at every kind of element; once with `strict`
-- right: the model loads, each is named with its place; with `strict` it is refused
-- args: --duration 0.1
-- expect: mjcf_unheard.xml:2:3: the attribute 'colour' of <compiler> is not supported
-- expect: mjcf_unheard.xml:3:3: the attribute 'warp' of <option> is not supported
-- expect: mjcf_unheard.xml:4:5: the attribute 'hyperspace' of <flag> is not supported
-- expect: mjcf_unheard.xml:7:5: the attribute 'glare' of <headlight> is not supported
-- expect: mjcf_unheard.xml:8:5: the element <hologram> is not supported
-- expect: mjcf_unheard.xml:11:5: the attribute 'sparkle' of <geom> is not supported
-- expect: mjcf_unheard.xml:12:5: the element <wheel> is not supported
-- expect: mjcf_unheard.xml:15:5: the attribute 'smell' of <material> is not supported
-- expect: mjcf_unheard.xml:18:5: the attribute 'beam' of <light> is not supported
-- expect: mjcf_unheard.xml:19:5: the attribute 'mood' of <body> is not supported
-- expect: mjcf_unheard.xml:20:7: the attribute 'squeak' of <freejoint> is not supported
-- expect: mjcf_unheard.xml:22:7: the element <propeller> is not supported
-- expect: mjcf_unheard.xml:26:5: the attribute 'tempo' of <key> is not supported
-- expect: mjcf_unheard.xml:28:3: the element <teleporter> is not supported
include "house.lua"
include "../lib/judge.lua"
files() scene() physics("OdeEngine") simulation()
get("/usr/scene"):importScene("mjcf_unheard.xml")
judge("the box is there", get("/usr/scene/unheard/box/body") ~= nil)
get("/sys/server/scene/mjcf").strict = true
local loaded = pcall(function() get("/usr/scene"):importScene("mjcf_unheard.xml") end)
judge("strict refuses it", not loaded)
