-- The Fujitsu HOAP-2 walks in a circle: it shifts its weight from foot to foot, and moves the free foot ahead.
--
--     sparkhost --config hoap2.lua
--     sparkhost --config hoap2.lua --set stride=0 --set turn=0           it steps on the spot
--     sparkhost --config hoap2.lua --set walkers=0                       one place is free for an agent over TCP
--
-- The agent hears (HJ (n rleg3) (ax deg)) of 25 joints and sends their speeds in rad/s, (rleg3 0.5); the head of
-- scenes/agent/hoap2/hoap2.rsg names them.
include "house.lua" include "materials.lua"

local walkers = option{ name = "walkers", default = 1, choices = { 0, 1 }, doc = "Robots that are driven from inside." }
local period  = option{ name = "period", default = 1.6, doc = "Time of two steps, in seconds." }
local stride  = option{ name = "stride", default = 8.0, doc = "How far the hips swing ahead and back, in degrees." }
local turn    = option{ name = "turn", default = 1.5, doc = "How far the hips turn, in degrees." }
local sway    = option{ name = "sway", default = 12.0, doc = "How far the legs tilt to the side, in degrees." }
local lift    = option{ name = "lift", default = 14.0, doc = "How much further the free knee bends, in degrees." }

files() scene() materials() physics(engineOption()) simulation()
local agents = agents{}
agents.maxAgents = 1
monitors{} web() control() plugin "effectors" plugin "sensors"
local walk = status{ playMode = "Walk", x = 0, y = 0, height = 0 }

get("/usr/scene"):importScene("rsg/ground.rsg", 1, -2, 3)          -- and a lamp there

local rule = agents:new("ScriptAspect", "walk")
rule:on("agentConnected", function(self, event)
  get(event.data).localPos = { 1, 0, 0 }
  get(event.data):importScene("rsg/agent/hoap2/hoap2.rsg")
  state.torso = get(event.data):find("hoap2/torso/body")
end)
rule:on("agentLeaving", function() state.torso = nil end)
rule:on("judge", function()
  if not state.torso then return end
  for i, name in ipairs{ "x", "y", "height" } do walk[name] = math.floor(1000 * state.torso.position[i]) / 1000 end
end)

-- Angles of a leg's joints [deg] at a phase; side: 1 right, -1 left; share: of the whole movement.
local function leg(side, phase, share)
  local isFree = math.max(0, -side * math.sin(phase) - 0.2) / 0.8
  local ahead, tilt, bend = share * side * math.cos(phase), share * sway * math.sin(phase), 20 + share * lift * isFree
  return { turn * ahead, tilt, bend + stride * ahead, -2 * bend, bend - stride * ahead, -tilt }
end

if walkers == 1 then
  new("ScriptBehavior", "/usr/agent/walker"):on("think", function(self, event)
    local phase, share, actions = 2 * math.pi * event.time / period, math.min(1, event.time / 3), {}
    local arm = 40 * share * math.cos(phase)
    local targets = { rleg = leg(1, phase, share), lleg = leg(-1, phase, share),
                      rarm = { -arm, -8, 0, 30 }, larm = { arm, 8, 0, 30 } }
    for _, percept in ipairs(event.data) do
      if percept[1] == "HJ" then
        local name, number = percept[2][2]:match("^(%a+)(%d?)$")
        local target = targets[name] and targets[name][tonumber(number)] or 0
        actions[#actions + 1] = string.format("(%s%s %.3f)", name, number, 0.3 * (target - percept[3][2]))
      end
    end
    self.actions = table.concat(actions)
  end)
end
