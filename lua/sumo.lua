-- Sumo: two robots push each other out of a ring. This file is the whole game: bodies, a perceptor, an effector, the
-- rule, the score and the players.
--
--     sparkhost --config sumo.lua                                        the page shows the fight and the score
--     sparkhost --config sumo.lua --rate max --set bouts=20 --seed 7     twenty bouts as fast as possible
--     sparkhost --config sumo.lua --set players=1                        one place is free for an agent over TCP
--
-- A robot is built when its agent connects. In each cycle it gets where the opponent and the middle of the ring are, as
-- it sees them (degrees to the left, metres), and it answers with a push (forwards and turning, each from -1 to 1):
--
--     (opponent (bearing 12.50) (distance 0.84))(middle (bearing -170.21) (distance 0.45))
--     (push 1 0.3)(syn)
include "house.lua"
include "materials.lua"

local bouts   = option{ name = "bouts", default = 5, doc = "Bouts of a game; 0: without end." }
local limit   = option{ name = "limit", default = 20.0, doc = "After this time a bout is a draw, in seconds." }
local players = option{ name = "players", default = 2, choices = { 0, 1, 2 }, doc = "Robots driven from inside." }

local ring, size = 1.0, 0.15                 -- radii [m]
local force, torque = 30, 1                  -- of a full push [N, Nm]
local colours = { "matRed", "matBlue" }

-- the servers
files() scene() materials() physics(engineOption()) simulation()
local control_ = agents{}
control_.maxAgents = 2
monitors{} web() control()
plugin "effectors"
local game = status{ playMode = "Wait", score = { 0, 0 }, teams = { "Red", "Blue" }, bout = 0 }

-- the ring
local ground = new("Transform", "/usr/scene/ground")
ground:new("PlaneCollider", "plane"):new("ContactJointHandler", "surface").contactMu = 0
local disc = ground:new("Cylinder", "ring")
disc:setParams(ring, 0.01)
disc:setScale(ring, ring, 0.01)
disc:setMaterial("matYellow")
local lamp = new("Transform", "/usr/scene/lamp")
lamp.localPos = { 2, -2, 4 }
lamp:new("Light", "light").diffuse = { 1, 1, 1, 1 }

-- A robot: a drum that glides, with two senses and one muscle. `agent`: its aspect; `side`: 1 or 2.
-- What must last from event to event is in `state`, which is saved with the game.
local robots = {}
state.robots = robots

local function pose(robot)
  local m = robot.agent.localTransform
  return m[13], m[14], math.atan(m[2], m[1])
end

-- Where a point is, as the robot sees it.
local function seen(robot, x, y)
  local fromX, fromY, heading = pose(robot)
  local bearing = math.deg(math.atan(y - fromY, x - fromX) - heading)
  return { bearing = (bearing + 180) % 360 - 180, distance = math.sqrt((x - fromX) ^ 2 + (y - fromY) ^ 2) }
end

local function build(agent, side)
  local robot = { agent = agent, side = side, body = agent:new("RigidBody", "body") }
  robot.body:setSphereTotal(5, size)
  local drag = robot.body:new("DragController", "drag")
  drag.linearDrag, drag.angularDrag = 15, 0.4
  local hull = agent:new("SphereCollider", "hull")
  hull.radius = size
  hull:new("ContactJointHandler", "surface").contactMu = 0
  local nose = agent:new("Transform", "nose")                                  -- shows where it looks
  nose.localPos = { 0.6 * size, 0, 0 }
  nose:new("Box", "shape"):setExtents(0.9 * size, 0.5 * size, 0.5 * size)
  nose:find("shape"):setMaterial("matWhite")
  local drum = agent:new("Cylinder", "drum")
  drum:setParams(size, size)
  drum:setScale(size, size, size)
  drum:setMaterial(colours[side])

  agent:new("ScriptPerceptor", "opponent"):on("perceive", function()
    local other = robots[3 - side]
    if not other then return nil end
    local x, y = pose(other)
    return seen(robot, x, y)
  end)
  agent:new("ScriptPerceptor", "middle"):on("perceive", function() return seen(robot, 0, 0) end)
  agent:new("ScriptEffector", "push"):on("perform", function(self, event)
    local _, ahead, turn = table.unpack(event.data)
    if type(ahead) ~= "number" or type(turn) ~= "number" then
      return "expected (push forwards turning), two numbers from -1 to 1, found " .. #event.data - 1 .. " values"
    end
    ahead, turn = math.max(-1, math.min(1, ahead)), math.max(-1, math.min(1, turn))
    local _, _, heading = pose(robot)
    robot.body:addForce(force * ahead * math.cos(heading), force * ahead * math.sin(heading), 0)
    robot.body:addTorque(0, 0, torque * turn)
  end)
  agent:new("AgentSyncEffector", "syn")
  agent:find("_CreateEffector"):delete()       -- a robot cannot ask for another one
  return robot
end

-- the rule
state.since = 0                               -- time at which the bout began [s]

-- Puts a robot on its side, at rest, at a random angle.
local function place(robot)
  local side = robot.side == 1 and -1 or 1
  robot.agent.localPos = { 0.5 * side, 0.4 * (math.random() - 0.5), size }
  robot.agent:setLocalRotation(0, 0, (side < 0 and 0 or 180) + 60 * (math.random() - 0.5))
  robot.body.velocity, robot.body.angularVelocity = { 0, 0, 0 }, { 0, 0, 0 }
end

local function begin(time)
  place(robots[1])
  place(robots[2])
  state.since = time
  game.bout, game.playMode = game.bout + 1, "Fight"
end

local function isOut(robot)
  local x, y = pose(robot)
  return x * x + y * y > ring * ring
end

local rule = control_:new("ScriptAspect", "sumo")

rule:on("agentConnected", function(self, event)
  local side = robots[1] and 2 or 1
  robots[side] = build(get(event.data), side)
  place(robots[side])
end)

rule:on("agentLeaving", function(self, event)
  for side, robot in pairs(robots) do
    if robot.agent.path == event.data then robots[side] = nil end
  end
  if game.playMode == "Fight" then game.playMode = "Wait" end
end)

rule:on("judge", function(self, event)
  if game.playMode == "Over" or not robots[1] or not robots[2] then return end
  if game.playMode == "Wait" then return begin(event.time) end
  local out = { isOut(robots[1]), isOut(robots[2]) }
  if not out[1] and not out[2] and event.time - state.since < limit then return end
  local score = game.score
  if out[2] and not out[1] then score[1] = score[1] + 1 end
  if out[1] and not out[2] then score[2] = score[2] + 1 end
  game.score = score
  print(string.format("bout %d took %.2f s: %d:%d", game.bout, event.time - state.since, score[1], score[2]))
  if bouts == 0 or game.bout < bouts then return begin(event.time) end
  game.playMode = "Over"
  get("/sys/server/simulation"):stop()
end)

-- A player: it aims beside the opponent, at another angle now and then, and turns back at the edge.
local function play(player, mind)
  player:on("think", function(self, event)
    local sight = {}
    for _, percept in ipairs(event.data) do
      sight[percept[1]] = { bearing = percept[2][2], distance = percept[3][2] }
    end
    self.actions = ""
    if not sight.opponent then return end
    if mind.cycle % 50 == 0 then mind.aside = 40 * (2 * math.random() - 1) end
    mind.cycle = mind.cycle + 1
    local aim = sight.opponent.bearing + mind.aside
    if sight.middle.distance > 0.8 * ring then aim = sight.middle.bearing end
    local ahead = math.cos(math.rad(aim))
    self.actions = string.format("(push %.3f %.3f)", ahead, aim / 60)
  end)
end
state.minds = {}
for i = 1, players do
  state.minds[i] = { aside = 0, cycle = 0 }
  play(new("ScriptBehavior", "/usr/agent/player" .. i), state.minds[i])
end
