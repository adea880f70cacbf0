-- row: N4
-- input: a config fills a table without end
-- right: an error with file and line before the memory of the machine is used up
-- slow: yes
-- exit: 2
-- expect: memory_of_scripts.lua:12: the scripts of a host may hold 1024 MiB
include "house.lua"
files()
scene()
simulation()
local all = {}
for i = 1, 1e9 do all[i] = i end
