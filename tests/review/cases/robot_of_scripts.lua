-- A scene file gives a robot a perceptor and an effector in Lua; their scripts are beside the config, also when the
-- robot is loaded during the run.
-- expect: shout: 4 apples
-- expect: shout: expected (shout number), found 'none'
-- args: --rate max --duration 0.3 --agent-port 0
include "house.lua"
files() scene() simulation()
agents{}.robotFolder = ""

local player = new("ScriptBehavior", "/usr/agent/player")
player:on("start", function(self) self.actions = "(scene rsg/review/scripted.rsg 2)" end)
player:on("think", function(self, event)
  local percept = event.data[1]                            -- { "basket", { "apples", 4 } }
  self.actions = event.cycle > 10 and "(shout none)" or string.format("(shout %d)", percept[2][2])
end)
