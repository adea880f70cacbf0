-- row: 24
-- input: --set with the bare name of a server's property
-- right: an error that names its path
-- args: --duration 0.1 --set threads=2
-- expect: unknown setting 'threads': the config declares no option of that name.
-- expect: Did you mean '/sys/server/simulation.threads'?
-- exit: 2
include "house.lua"
files() scene() physics() simulation()
