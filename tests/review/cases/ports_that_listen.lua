-- A port that listens stays where it is: another number for it is refused, and so is another token of the page. The same
-- number as before is no change. Where drawings come in is in the log.
-- expect: Drawings of agents come in at UDP port
-- expect: .port: it listens on
-- expect: /sys/server/web.port: it listens on
-- expect: /sys/server/web.setToken: it listens on
-- expect: refused 3 of 3, the same number twice is taken: true true
-- expect: "cycles":2,
-- args: --rate max --duration 0.04 --agent-port 0 --monitor-port 0 --set webPort=0 --set drawings=0
include "soccer-sphere.lua"
on("act", function(self, event)
  if event.cycle ~= 1 then return end
  local agents, web = get("/sys/server/net/agents"), get("/sys/server/web")
  local refused = 0
  local function wrong(change)
    local done, why = pcall(change)
    print(why)
    if not done then refused = refused + 1 end
  end
  wrong(function() agents.port = agents.port - 1 end)
  wrong(function() web.port = web.port - 1 end)
  wrong(function() web:setToken("another-long-secret-word") end)
  local again = pcall(function() agents.port = agents.port end)
  local page = pcall(function() web.port = web.port end)
  print("refused " .. refused .. " of 3, the same number twice is taken:", again, page)
end)
