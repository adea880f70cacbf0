-- row: 8
-- input: models of three languages with masses and densities of 1e300, shapes of 1e200 m and parts without a mass
-- right: each is mended and named, and all falls, a ball beside them too
-- engines: all
-- args: --duration 0.5
-- expect: <geom> 'beam' is left out: expected places at most 1e+06 m away for 'fromto'
-- expect: <geom> 'bubble' adds no mass to its body: expected at most 1e+15 kg and 1e+30 kg m^2
-- expect: <geom> 'block', a mass of 1e+300 kg is taken as 1e+15 kg
-- expect: <geom> 'core', a mass of 4.18879e+297 kg is taken as 1e+15 kg
-- expect: heavy_geoms.xml:6:7: a <body> that moves and has no mass gets 10 g (and 2 more)
-- expect: heavy_geoms.urdf:4:5: <collision> is left out
-- expect: <link> 'weight', a mass of 1e+300 is taken as 1e+15
-- expect: heavy_geoms.wbt:11:24: Capsule adds no mass to its body
-- expect: Sphere, a mass of 4.18879e+297 kg is taken as 1e+15 kg
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
local falling, count = { ball = ball("ball", 0.1, 0, 40, 5) }, 1
local function note(node, name)
  for _, child in ipairs(node:children()) do
    if child.class == "RigidBody" then
      falling[name .. "/" .. node.name], count = child, count + 1
    elseif child.class == "Transform" or child.class == "Space" then
      note(child, name)
    end
  end
end
for i, language in ipairs { "xml", "urdf", "wbt" } do
  local place = new("Transform", "/usr/scene/" .. language)
  place.localPos = { 0, 10 * i, language == "xml" and 0 or 5 }
  place:importScene("heavy_geoms." .. language)
  note(place, language)
end
atTime(0.4, function()
  for name, body in pairs(falling) do near("the height of " .. name, body.position[3], 4.195, 0.025) end
  near("the number of bodies", count, 14, 0)
end)
for language, file in pairs { mjcf = "xml", urdf = "urdf", webots = "wbt" } do
  get("/sys/server/scene/" .. language).strict = true
  local refused = not pcall(function() get("/usr/scene"):importScene("heavy_geoms." .. file, "strict-") end)
  judge("strict refuses the " .. file, refused)
end
