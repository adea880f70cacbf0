-- Where `sparkhost --convert IN OUT.rsg` imports a file: an empty scene with physics and the classes of robots.
include "house.lua"
include "materials.lua"

files()
scene()
materials()
physics()
simulation()
for _, name in ipairs { "gamecontrol", "sensors", "effectors", "soccer", "modifiers" } do plugin(name) end
