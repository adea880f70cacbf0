-- row: 14
-- input: noise, bias and gain below a scanner, an orientation, a matrix and a switch
-- right: no echo stays so, ranges stay in range, rotations stay rotations
-- args: --duration 6
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics() simulation() agents{ port = 0 }
plugin "sensors" plugin "modifiers"
local wall = new("Transform", "/usr/scene/space/wall")
wall.localPos = { 0, 1, 0 }
wall:new("BoxCollider", "box").boxLengths = { 0.5, 0.2, 1 }
local probe = new("Transform", "/usr/scene/probe")
probe:setLocalRotation(0, 0, 30)
local agent = probe:new("AgentAspect", "agent")
local head = agent:new("Transform", "head")
head:setLocalRotation(0, 0, -30)
local function scanner(name, class, set)
  local scan = head:new("LidarPerceptor", name)
  scan.rays, scan.fov, scan.minRange, scan.maxRange = 4, 360, 0.2, 4
  local modifier = scan:new(class, "modifier")
  for k, v in pairs(set) do modifier[k] = v end
end
scanner("noisy", "WhiteNoise", { sigma = 1 })
scanner("biased", "Bias", { mean = -2 })
scanner("scaled", "Gain", { gain = 9 })
agent:new("OrientationPerceptor", "imu"):new("WhiteNoise", "noise").sigma = 0.4
agent:new("OrientationPerceptor", "off"):new("Bias", "bias").mean = 0.1
agent:new("GPS", "gps"):new("WhiteNoise", "noise").sigma = 0.3
local low, high, lost, least, most, count, worst = 9, 0, 0, 9, 0, 0, 0
watch(agent, function(seen, time)
  local d = seen["LDR noisy"] and seen["LDR noisy"][3]
  if not d then return end
  count = count + 1
  low, high = math.min(low, d[4]), math.max(high, d[4])
  for _, i in ipairs{ 2, 3, 5 } do if d[i] ~= 4 then lost = lost + 1 end end
  local q = seen["quat imu"][3]
  local norm = math.sqrt(q[2]^2 + q[3]^2 + q[4]^2 + q[5]^2)
  least, most = math.min(least, norm), math.max(most, norm)
  local m = seen["GPS gps"][3]
  for row = 0, 2 do
    local square = m[2 + 4 * row]^2 + m[3 + 4 * row]^2 + m[4 + 4 * row]^2
    worst = math.max(worst, math.abs(square - 1))
  end
  worst = math.max(worst, math.abs(m[17] - 1))
  if not isAt(time, 5.5) then return end
  judge(string.format("%d distances from %.3f to %.3f m are in range, and noisy", count, low, high),
        low >= 0.2 and high <= 4 and high - low > 1)
  near("distances of nothing that are other ones", lost, 0, 0)
  near("a negative distance is the least one", seen["LDR biased"][3][4], 0.2, 1e-9)
  near("and nothing stays nothing", seen["LDR biased"][3][2], 4, 1e-9)
  near("a large distance is the largest one", seen["LDR scaled"][3][4], 4, 1e-9)
  near("the shortest quaternion", least, 1, 1e-6)
  near("the longest quaternion", most, 1, 1e-6)
  near("rows of a rotation", worst, 0, 1e-5)
  local o, bias = seen["quat off"][3], math.sqrt(3) * 0.1
  local c, s = math.cos(math.rad(15)), math.sin(math.rad(15))
  near("a bias turns by its length", 2 * math.acos(math.abs(o[2] * c + o[5] * s)), bias, 1e-4)
end)
