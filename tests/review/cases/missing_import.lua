-- A missing imported file is an error with both positions, and --check fails.
-- exit: 2
-- expect: rsg/review/outer.rsg:3:
-- expect: there is no resource 'box.rsg'
-- expect: missing_import.lua:9: cannot call importScene of /usr/scene
-- args: --check
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene"):importScene("rsg/review/outer.rsg")
