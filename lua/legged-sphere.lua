-- A sphere walks on six legs, in a circle. Each joint follows a sine.
--
--     sparkhost --config legged-sphere.lua
--     sparkhost --config legged-sphere.lua --set walkers=0               one place is free for an agent over TCP
--
-- The agent hears (HJ (n hip1) (ax deg)) of its twelve joints, hip1 to hip6 and knee1 to knee6, and sends their speeds
-- in rad/s: (hip1 2.5)(knee1 -1).
include "house.lua" include "materials.lua"

local walkers = option{ name = "walkers", default = 1, choices = { 0, 1 }, doc = "Spheres that are driven from inside." }
local rate    = option{ name = "rate", default = 1.2, doc = "Steps of each leg in a second." }
local stride  = option{ name = "stride", default = 22.0, doc = "How far the hips swing to either side, in degrees." }
local lift    = option{ name = "lift", default = 25.0, doc = "How far the knees lift the feet, in degrees." }
local turn    = option{ name = "turn", default = 0.3, doc = "How much wider the right legs swing, and narrower the left." }

files() scene() materials() physics(engineOption()) simulation()
local agents = agents{}
agents.maxAgents = 1
monitors{} web() control() plugin "effectors" plugin "sensors"
local walk = status{ playMode = "Walk", way = 0, height = 0 }

get("/usr/scene"):importScene("rsg/ground.rsg", 2, -3, 4)          -- and a lamp there

-- the robot, and how far it came [m]
local rule = agents:new("ScriptAspect", "walk")
rule:on("agentConnected", function(self, event)
  get(event.data).localPos = { 1.5, 0, 0 }
  get(event.data):importScene("rsg/agent/legged-sphere/legged-sphere.rsg")
  state.torso, state.way, state.last = get(event.data):find("leggedSphere/torso/body"), 0, { 1.5, 0 }
end)
rule:on("agentLeaving", function() state.torso = nil end)
rule:on("judge", function()
  if not state.torso then return end
  local p, last = state.torso.position, state.last
  state.way, state.last = state.way + math.sqrt((p[1] - last[1]) ^ 2 + (p[2] - last[2]) ^ 2), { p[1], p[2] }
  walk.way, walk.height = math.floor(100 * state.way) / 100, math.floor(100 * p[3]) / 100
end)

-- The gait: legs 1, 3 and 5 take a step while 2, 4 and 6 stand.
if walkers == 1 then
  new("ScriptBehavior", "/usr/agent/walker"):on("think", function(self, event)
    local actions = {}
    for _, percept in ipairs(event.data) do
      local joint, leg = tostring(percept[2] and percept[2][2]):match("^(%a+)(%d)$")
      if percept[1] == "HJ" then
        local phase, isLeft = 2 * math.pi * (rate * event.time + leg / 2), leg > "1" and leg < "5"
        local swing = stride * (isLeft and 1 - turn or -1 - turn) * math.cos(phase)
        local target = joint == "hip" and swing or -lift * math.max(0, math.sin(phase))
        actions[#actions + 1] = string.format("(%s%s %.3f)", joint, leg, 0.25 * (target - percept[3][2]))
      end
    end
    self.actions = table.concat(actions)
  end)
end
