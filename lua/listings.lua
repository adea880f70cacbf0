-- The listings of the paper "Spark": the structure of a file, a template and its import, and the buggy, which drives.
--
--     sparkhost --config listings.lua
--     sparkhost --config listings.lua --set drivers=0                    one place is free for an agent over TCP
--
-- The agent hears the angle of the left back wheel about the steering axis, (H2J (n Hinge2Perceptor) (ax 0 deg)),
-- and sends the speed of that wheel in deg/s: (Hinge2Effector 180).
include "house.lua"
include "materials.lua"

local drivers = option{ name = "drivers", default = 1, choices = { 0, 1 }, doc = "Buggies driven from inside." }

files() scene() materials() physics(engineOption()) simulation()
local agents = agents{}
agents.maxAgents = 1
monitors{} web() control()
plugin "effectors"
plugin "sensors"
local drive = status{ playMode = "Drive", x = 0, y = 0, angle = 0 }

-- The listings name their files without a folder, so their folder is searched, too.
get("/sys/server/file"):new("DirectoryFileSystem", "listings").path = host.share .. "/scenes/listings"

get("/usr/scene"):importScene("rsg/ground.rsg", 6, -8, 12)          -- and a lamp there

local function place(name, x, y, z)
  local place = new("Transform", "/usr/scene/" .. name)
  place.localPos = { x, y, z }
  return place
end
place("listing1", 0, 0, 0.5):importScene("listing1.rsg", 1, 1, 1, 10, "matWhite")
place("listing2", -8, -5, 2):importScene("listing2.rsg")

-- The buggy is built when its agent connects. It drives in a circle about the cube of Listing 1.
local rule = agents:new("ScriptAspect", "buggy")
rule:on("agentConnected", function(self, event)
  get(event.data).localPos = { 5.5, 0, 0.4 }
  get(event.data):importScene("listing3.rsg")
  get(event.data):new("AgentSyncEffector", "syn")
  state.body = get(event.data):find("chassis/boxBody")
end)
rule:on("agentLeaving", function() state.body = nil end)
rule:on("judge", function()
  if state.body then drive.x, drive.y = state.body.position[1], state.body.position[2] end
end)

-- the driver
if drivers == 1 then
  new("ScriptBehavior", "/usr/agent/driver"):on("think", function(self, event)
    for _, percept in ipairs(event.data) do
      if percept[1] == "H2J" then drive.angle = math.floor(percept[3][3]) end
    end
    self.actions = "(Hinge2Effector 180)"
  end)
end
