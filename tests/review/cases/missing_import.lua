-- A missing imported file is reported with both positions, the rest of the outer file is loaded, and --check fails.
-- exit: 2
-- expect: rsg/review/outer.rsg:3:
-- expect: there is no resource 'box.rsg'
-- expect: the check failed: 1 error
-- args: --check
include "house.lua"
files() scene() physics() simulation()
get("/usr/scene"):importScene("rsg/review/outer.rsg")
