-- Rescue: three victims behind rubble that no robot can move alone. Robots clear the doors together.
--
--     sparkhost --config rescue.lua
--     sparkhost --config rescue.lua --set robots=1                       three places are free for agents over TCP
-- An agent hears where the rubble is that still blocks a door, from itself, in m, and sends a push, each from -1 to 1:
-- (rubble (block 1.20 -0.35) (block 4.18 -0.35)) and (push 1 0.2)(syn).
include "house.lua" include "materials.lua"
local robots = option{ name = "robots", default = 4, choices = { 0, 1, 2, 3, 4 }, doc = "Robots driven from inside." }
local force  = option{ name = "force", default = 120.0, doc = "Of a robot's full push, in N." }
files() scene() materials() physics(engineOption()) simulation()
agents{}.maxAgents = 4
monitors{} web() control() plugin "effectors" soundServer()
local game = status{ playMode = "Rescue", teams = { "Rescued", "Buried" }, score = { 0, 3 } }

get("/usr/scene"):importScene("rsg/rescue/site.rsg")
local function room(i) return { block = get("/usr/scene/block" .. i), victim = get("/usr/scene/victim" .. i) } end
local rooms = { room(1), room(2), room(3) }
local function isOpen(room) return math.abs(room.block.localPos[1] - room.victim.localPos[1]) > 1.1 end
local rule = new("ScriptAspect", "/sys/server/gamecontrol/rescue")
rule:on("agentConnected", function(self, event)
  local robot = get(event.data)
  robot.localPos = { -5.5, 0.3 * robot.number - 2.5, 0.14 }
  robot:importScene("rsg/rescue/robot.rsg")
  robot:find("_CreateEffector"):delete()                -- a robot cannot ask for another one
  robot:new("ScriptPerceptor", "rubble"):on("perceive", function()
    local seen = {}
    for _, room in ipairs(rooms) do
      local block, place = room.block.localPos, robot.localPos
      if not isOpen(room) then seen[#seen + 1] = { "block", block[1] - place[1], block[2] - place[2] } end
    end
    return seen
  end)
  robot:new("ScriptEffector", "push"):on("perform", function(self, event)
    local x, y = tonumber(event.data[2]), tonumber(event.data[3])
    if not (x and y) then return "expected (push x y), two numbers from -1 to 1" end
    robot:find("body"):addForce(force * math.max(-1, math.min(1, x)), force * math.max(-1, math.min(1, y)), 0)
  end)
end)
rule:on("judge", function(self, event)
  local free = 0
  for _, room in ipairs(rooms) do                       -- who is free walks out at 1 m/s
    local p = room.victim.localPos
    if p[2] < -2 then free = free + 1
    elseif isOpen(room) then room.victim.localPos = { p[1], p[2] - event.step, p[3] } end
  end
  if free > game.score[1] then print(string.format("%d of 3 are free after %.1f s", free, event.time)) end
  game.score, game.playMode = { free, 3 - free }, free < 3 and "Rescue" or "Over"
end)

-- The robots go along the road side by side, and up to the left of the first block, which they push to the right.
for i = 1, robots do
  new("ScriptBehavior", "/usr/agent/robot" .. i):on("think", function(self, event)
    local block = event.data[1] and event.data[1][2]    -- { "block", x, y }, or nil
    if not block then self.actions = "" return end
    local x, y = block[2] - 0.72, block[3] + ({ 0.15, -0.15, 0.45, -0.45 })[i]
    if math.abs(x) > 0.25 then x, y = math.abs(y - 1.5) < 0.2 and x or 0, y - 1.5
    else x = math.abs(y) < 0.15 and 1 or 2 * x end
    self.actions = string.format("(push %.3f %.3f)", x, 2 * y)
  end)
end
