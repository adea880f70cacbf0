-- A setting without a server that two servers have: the first of them in the tree is named.
-- exit: 2
-- expect: unknown setting 'port': the config declares no option of that name. Did you mean '/sys/server/web.port'?
-- args: --check --set port=1
include "soccer-sphere.lua"
assert(get("/sys/server/web").port and get("/sys/server/drawing").port)
