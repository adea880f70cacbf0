-- Attached to a node: its handlers at the rule refuse, for they fail. They end with the node.
local rule = ...
for _, channel in ipairs { "request", "action" } do
  rule:on(channel, function(self, event)
    if channel == "request" or event.data[2][1] == "push" then error("it fails") end
  end)
end
