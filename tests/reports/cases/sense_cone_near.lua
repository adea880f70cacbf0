-- row: 15
-- input: a sonar touches a wall, is inside of a box, and looks at a post behind a board and beside it
-- right: the least range at the wall and in the box; the post is silent behind the board, and heard beside it
-- args: --duration 0.6
include "../lib/judge.lua"
include "../lib/senses.lua"
files() scene() physics() simulation() agents{ port = 0 }
plugin "sensors"
local function sonar(name, at)
  local probe = new("Transform", "/usr/scene/" .. name)
  probe.localPos = at
  local agent = probe:new("AgentAspect", "agent")
  local ear = agent:new("SonarPerceptor", name)
  ear.byRays, ear.maxEchoes, ear.senseCone, ear.minRange, ear.maxRange = true, 2, 50, 0.05, 4
  return agent
end
local function box(at, lengths)
  local place = get("/usr/scene/space"):new("Transform", "box" .. at[1] .. at[2])
  place.localPos = at
  place:new("BoxCollider", "box").boxLengths = lengths
end
box({ 0, 0.51, 0 }, { 2, 1, 2 })                 -- 1 cm ahead
box({ 10, 0, 0 }, { 1, 1, 1 })                   -- around it
box({ 20, 1, 0 }, { 0.6, 0.02, 3 })              -- a board, 1 m ahead
local function post(x, y)
  local place = new("Transform", "/usr/scene/space/post" .. x)
  place.localPos = { x, y, 0 }
  local c = place:new("CapsuleCollider", "c")
  c.radius, c.length = 0.02, 0.5
end
post(20, 2)
box({ 30, 1, 0 }, { 0.6, 0.02, 3 })
post(30.7, 2)
local function expect(agent, name, first, second)
  watch(agent, function(seen, time)
    if not isAt(time, 0.4) then return end
    local d = seen["US " .. name][3]
    near(name .. ": first", d[1], first, 2e-3)
    near(name .. ": second", d[2], second, 2e-3)
  end)
end
expect(sonar("touching", { 0, 0, 0 }), "touching", 0.05, 4)
expect(sonar("inside", { 10, 0, 0 }), "inside", 0.05, 4)
expect(sonar("behind", { 20, 0, 0 }), "behind", 0.99, 4)
expect(sonar("beside", { 30, 0, 0 }), "beside", 0.99, math.sqrt(0.49 + 4) - 0.02)
