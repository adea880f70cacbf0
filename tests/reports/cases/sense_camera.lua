-- row: 14
-- input: noise below a camera of depths, and below one of colours
-- right: pixels of what is there change from picture to picture; where nothing is, nothing changes
-- args: --duration 0.5
include "../lib/judge.lua"
include "../lib/senses.lua"
include "materials.lua"
files() scene() materials() physics() simulation() agents{ port = 0 }
camera()
plugin "sensors" plugin "modifiers"
local crate = new("Transform", "/usr/scene/crate")
crate.localPos = { 0, 3, 0 }
local box = crate:new("Box", "box")
box:setExtents(1, 1, 1)
box:setMaterial("matOrange")
local agent = new("Transform", "/usr/scene/probe"):new("AgentAspect", "agent")
local function eye(name, picture, sigma)
  local e = agent:new("ImagePerceptor", name)
  e.width, e.height, e.picture = 12, 6, picture
  if sigma then e:new("WhiteNoise", "noise").sigma = sigma end
end
eye("deep", "depth", 40)
eye("bright", "colour", 10)
eye("exact", "depth")
local code = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
local function bytes(text)
  local out, bits, count = {}, 0, 0
  for c in text:gmatch("[%w+/]") do
    bits, count = bits * 64 + code:find(c, 1, true) - 1, count + 6
    if count >= 8 then
      count = count - 8
      out[#out + 1], bits = bits >> count, bits & ((1 << count) - 1)
    end
  end
  return out
end
local function depths(p)
  local b, out = bytes(p[#p][2]), {}
  for i = 1, #b, 2 do out[#out + 1] = b[i] + 256 * b[i + 1] end
  return out
end
local pictures, last, same, wrong, sum, count = 0, {}, 0, 0, 0, 0
watch(agent, function(seen, time)
  local deep, bright, exact = seen["IMG deep"], seen["IMG bright"], seen["IMG exact"]
  if deep then
    pictures = pictures + 1
    if last.deep == deep[#deep][2] or last.bright == bright[#bright][2] then same = same + 1 end
    last.deep, last.bright = deep[#deep][2], bright[#bright][2]
    local a, b = depths(deep), depths(exact)
    for i = 1, #b do
      if (b[i] == 0) ~= (a[i] == 0) then wrong = wrong + 1 end
      if b[i] ~= 0 then sum, count = sum + (a[i] - b[i])^2, count + 1 end
    end
  end
  if not isAt(time, 0.4) then return end
  judge("pictures differ: " .. pictures .. ", the same as the last one: " .. same, pictures > 10 and same == 0)
  near("pixels of nothing that are something", wrong, 0, 0)
  near("the noise of " .. count .. " depths [mm]", math.sqrt(sum / count), 40, 6)
end)
