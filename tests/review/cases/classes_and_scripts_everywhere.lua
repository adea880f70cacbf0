-- Class objects are nodes, scripts attach to nodes of every kind, and plugins and servers can be added at run time.
-- expect: HingeJoint derives from Generic6DOFJoint, of plugin physics
-- expect: 2 transforms live
-- expect: ../world is /usr/scene/world
-- expect: the script of /classes/HingeJoint runs in cycle 3
-- expect: the script of /plugins/physics runs in cycle 3
-- expect: the script of /sys/server/physics/engine runs in cycle 3
-- expect: the script of / runs in cycle 3
-- expect: /usr/scene/a (class Transform) has no property or method 'foo'
-- expect: made /sys/server/drawing
-- expect: gone: nil
include "house.lua"
files() scene() physics() simulation()
local class = get("/classes/HingeJoint")
print("HingeJoint derives from " .. class.base .. ", of plugin " .. class.providedBy)
local a = new("Transform", "/usr/scene/a")
new("Transform", "/usr/scene/b")
print(get("/classes/Transform").living .. " transforms live")
print("../world is " .. tostring(a:find("../world")))
print(select(2, pcall(function() a:foo() end)))
for _, path in ipairs{ "/classes/HingeJoint", "/plugins/physics", "/sys/server/physics/engine", "/sys/server/file", "/usr/scene/world", "/usr", "/" } do
  get(path):attachScript("scripts/count.lua")
end
on("act", function(self, event)
  if event.cycle ~= 3 then return end
  plugin "drawing"
  print("made " .. tostring(new("DrawingServer", "/sys/server/drawing")))
  delete("/sys/server/drawing")
  print("gone: " .. tostring(get("/sys/server/drawing")))
end)
