-- row: 24
-- input: a model in MJCF with an equality between sites and a word where numbers belong
-- right: the log names both in the language of MJCF, as no log of another language does
-- args: --duration 0.1
-- expect: an equality between sites is not supported
-- expect: 'solref'
include "../lib/judge.lua"
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene"):importScene("absent.xml")
judge("the model loads", get("/usr/scene/absent/arm/body") ~= nil)
