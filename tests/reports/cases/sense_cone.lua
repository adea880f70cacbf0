-- row: 15
-- input: thin things are carried through the cone of a sonar: a post, a rod that lies, a turned board, a small ball,
--   a mesh
-- right: each is heard at every bearing inside, at the distance of its nearest point
-- args: --duration 3
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics() simulation() agents{ port = 0 }
plugin "sensors"
local probe = new("Transform", "/usr/scene/probe")
probe.localPos = { 1, 2, 3 }
probe:setLocalRotation(0, 0, 20)
local agent = probe:new("AgentAspect", "agent")
local ear = agent:new("SonarPerceptor", "ear")
ear.byRays, ear.maxEchoes, ear.senseCone, ear.minRange = true, 1, 50, 0.1
-- Things stand in the frame of the probe.
local frame = new("Transform", "/usr/scene/space/frame")
frame.localPos = { 1, 2, 3 }
frame:setLocalRotation(0, 0, 20)
local things = {}
local function thing(name, class, set, turn)
  local place = frame:new("Transform", name)
  place.localPos = { 0, -50, 0 }
  if turn then place:setLocalRotation(table.unpack(turn)) end
  local c = place:new(class, "c")
  for k, v in pairs(set) do c[k] = v end
  things[#things + 1] = place
end
thing("post", "CylinderCollider", { radius = 0.01, length = 0.8 })
thing("rod", "CapsuleCollider", { radius = 0.01, length = 0.2 }, { 90, 0, 0 })
thing("board", "BoxCollider", { boxLengths = { 0.002, 0.002, 0.5 } }, { 0, 0, 45 })
thing("ball", "SphereCollider", { radius = 0.015 })
thing("wire", "ConvexCollider", { vertices = { 0, 0, -0.4, 0.004, 0, -0.4, 0, 0.004, -0.4, 0, 0, 0.4 } })
local reach = { post = 0.01, rod = 0.1, board = 0.0015, ball = 0.015, wire = 0.004 }
local bearing, current, heard, tried, wrong = -24, 1, 0, 0, 0
on("prepare", function()
  local a = math.rad(bearing)
  for i, place in ipairs(things) do
    place.localPos = i == current and { 2 * math.sin(a), 2 * math.cos(a), 0 } or { 0, -50, 0 }
  end
end)
watch(agent, function(seen)
  local us = seen["US ear"]
  if not us or not things[current] then return end
  local name, d = things[current].name, us[3][1]
  tried = tried + 1
  if d < 4.9 then heard = heard + 1 end
  if math.abs(d - 2) > reach[name] + 0.02 then wrong = wrong + 1 end
  bearing = bearing + 2
  if bearing > 24 then
    judge(string.format("the %s is heard at %d of %d bearings, %d distances are wrong", name, heard, tried, wrong),
          heard == tried and wrong == 0)
    bearing, current, heard, tried, wrong = -24, current + 1, 0, 0, 0
  end
end)
