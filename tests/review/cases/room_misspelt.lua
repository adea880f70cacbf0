-- A misspelt function of house.lua is an error with the nearest name.
-- exit: 2
-- expect: room_misspelt.lua:5: attempt to call a nil value (global 'phsyics'). Did you mean 'physics'
include "house.lua"
files() scene() phsyics() simulation()
