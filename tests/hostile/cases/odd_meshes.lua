-- row: A4
-- input: meshes with a vertex that no triangle has, with triangles of no area, twice, inside out, in one plane, huge
--   and tiny, under and above falling balls
-- right: each is a collider or refused, and the balls stay where numbers are
-- engines: all
-- args: --duration 1e6 --log-level error
-- expect: right: meshes
include "house.lua"
files() scene() physics(engineOption()) simulation()
local space = get "/usr/scene/space"
space:new("PlaneCollider", "ground"):new("ContactJointHandler", "surface")

local SQUARE = { -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0 }
local function scaled(by)
  local out = {}
  for i, v in ipairs(SQUARE) do out[i] = v * by end
  return out
end
local function grid(n)
  local vertices, triangles = {}, {}
  for y = 0, n do for x = 0, n do
    vertices[#vertices + 1] = x / n - 0.5
    vertices[#vertices + 1] = y / n - 0.5
    vertices[#vertices + 1] = 0.1 * ((x + y) % 2)
  end end
  for y = 0, n - 1 do for x = 0, n - 1 do
    local at = y * (n + 1) + x
    for _, i in ipairs{ at, at + 1, at + n + 1, at + 1, at + n + 2, at + n + 1 } do triangles[#triangles + 1] = i end
  end end
  return vertices, triangles
end
local gridVertices, gridTriangles = grid(6)
local MESHES = {
  { "one triangle of four vertices", SQUARE, { 0, 1, 2 } },
  { "one triangle, the first vertex unused", SQUARE, { 1, 2, 3 } },
  { "no area", SQUARE, { 0, 0, 0 } },
  { "a line", SQUARE, { 0, 1, 1 } },
  { "some without area", SQUARE, { 0, 1, 2, 1, 1, 2, 0, 2, 3 } },
  { "twice", SQUARE, { 0, 1, 2, 0, 1, 2, 0, 1, 2 } },
  { "both sides", SQUARE, { 0, 1, 2, 0, 2, 1 } },
  { "three at an edge", { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0 }, { 0, 1, 2, 0, 1, 3, 0, 1, 4 } },
  { "equal vertices", { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }, { 0, 1, 2, 0, 2, 3 } },
  { "tiny", scaled(1e-200), { 0, 1, 2, 0, 2, 3 } },
  { "small", scaled(1e-9), { 0, 1, 2, 0, 2, 3 } },
  { "huge", scaled(9e5), { 0, 1, 2, 0, 2, 3 } },
  { "too huge", scaled(1e30), { 0, 1, 2, 0, 2, 3 } },
  { "an index too many", SQUARE, { 0, 1, 4 } },
  { "a grid with unused vertices", gridVertices, { table.unpack(gridTriangles, 1, 60) } },
}

local function ball(at, name, place)
  local node = at:new("Transform", name)
  node.localPos = place
  local body = node:new("RigidBody", "body")
  body:setSphereTotal(1, 0.1)
  local shape = node:new("SphereCollider", "shape")
  shape.radius = 0.1
  shape:new("ContactJointHandler", "surface")
  return body
end

local current, age, at, balls, wrong = 0, 0, nil, {}, 0
local function begin()
  local name, vertices, triangles = table.unpack(MESHES[(current - 1) // 4 + 1])
  local kind = (current - 1) % 4     -- alone; on a body; of convex corners; both
  at = space:new("Transform", "at")
  balls = { ball(at, "above", { 0, 0, 0.35 }), ball(at, "beside", { 0.3, 0.2, 0.3 }) }
  pcall(function()
    local node = at:new("Transform", "mesh")
    node.localPos = { 0, 0, 0.1 }
    if kind > 0 then balls[3] = node:new("RigidBody", "body") end
    local mesh = node:new(kind == 2 and "ConvexCollider" or "TriMeshCollider", "shape")
    mesh:new("ContactJointHandler", "surface")
    mesh.vertices = vertices
    if kind ~= 2 then mesh.triangles = triangles end
    if kind == 3 then
      local box = node:new("BoxCollider", "box")
      box.boxLengths = { 0.1, 0.1, 0.1 }
    end
  end)
end
on("rule", function()
  if at then
    age = age + 1
    if age < 8 then return end
    for _, body in ipairs(balls) do
      local p = body.position
      for i = 1, 3 do
        if not (math.abs(p[i]) < 100) then
          wrong = wrong + 1
          log.error(string.format("wrong: %s, kind %d: a body is at %g %g %g",
                                  MESHES[(current - 1) // 4 + 1][1], (current - 1) % 4, p[1], p[2], p[3]))
        end
      end
    end
    at:delete()
    at = nil
  end
  if current < 4 * #MESHES then
    current, age = current + 1, 0
    begin()
  else
    local faults = get("/sys/server/simulation").faults
    log.error((wrong == 0 and faults == 0 and "right" or "wrong") .. ": meshes: " .. #MESHES .. ", faults: " .. faults)
    get("/sys/server/simulation"):stop()
  end
end)
