-- Servers and scenes are found by their paths, so they cannot be renamed while the simulation runs.
-- expect: cannot name /sys/server 'x' now
-- expect: cannot name /sys/server/gamecontrol 'x' now: /sys is in use: servers keep their names while the run loop is at work
-- expect: cannot name /sys/server/gamecontrol/GameStateAspect 'x' now
-- expect: cannot name /sys/variables/Soccer 'x' now
-- expect: cannot name /usr/scene 'x' now: /usr is in use: scenes keep their names while the run loop is at work
-- expect: named /usr/scene/x
-- expect: "cycles":100,
-- args: --rate max --duration 2 --agent-port 0 --monitor-port 0 --set web=false
include "soccer-sphere.lua"
new("Transform", "/usr/scene/marker")
on("act", function(self, event)
  if event.cycle ~= 50 then return end
  for _, path in ipairs{ "/sys", "/sys/server", "/sys/server/gamecontrol", "/sys/server/gamecontrol/GameStateAspect", "/sys/server/net",
                         "/sys/variables", "/sys/variables/Soccer", "/usr", "/usr/scene" } do
    print(select(2, pcall(function() get(path).name = "x" end)))
  end
  local marker = get("/usr/scene/marker")
  marker.name = "x"
  print("named " .. tostring(marker))
end)
