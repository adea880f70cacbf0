-- row: p77
-- input: an agent creates its robot from a file that is not there
-- right: a warning says that nothing is created
-- args: --duration 0.4 --agent-port 0
-- expect: warning agent 1 (/usr/scene/maker/agent/mind): create: nothing is created: there is no resource
include "house.lua"
files() scene() physics() simulation() agents{} plugin "effectors"
local agent = new("Transform", "/usr/scene/maker"):new("AgentAspect", "agent")
agent:new("CreateEffector", "make").scene = "rsg/agent/absent.rsg"
agent:new("ScriptBehavior", "mind"):on("think", function(self) self.actions = "(create)" end)
