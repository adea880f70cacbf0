-- row: 2
-- input: robots of three languages with links of 1e-16 kg and moments of 1e-18 kg m^2, a grain of dust, a ball
-- right: all load and fall
-- engines: all
-- args: --duration 0.5
-- expect: <body> 'hair', a mass of 1e-16 is taken as 1e-15
-- never: MuJoCo does not take this world
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
local falling = { ball = ball("ball", 0.1, 4, 0, 5) }
for i, language in ipairs { "xml", "urdf", "wbt" } do
  local place = new("Transform", "/usr/scene/" .. language)
  place.localPos = { 10 * i, 0, language == "xml" and 0 or 5 }
  place:importScene("tiny_links." .. language)
  for _, part in ipairs(place:children()[1]:children()) do
    local body = part:find "body"
    if body then falling[language .. " " .. part.name] = body end
  end
end
atTime(0.4, function()
  local count = 0
  for name, body in pairs(falling) do
    count = count + 1
    near("the height of " .. name, body.position[3], 4.195, 0.025)
  end
  near("the number of bodies that fall", count, 11, 0)
end)
