-- What templates in Lua find: fields, context, the modules wb*, print; random numbers and times that are the same in
-- each run, tables that are visited in order of their keys, and no files. The arguments are fields, context and a
-- function that takes what the template prints.
local fields_, context_, say_ = ...
fields, context = fields_, context_

local function say(...)
  local texts = {}
  for i = 1, select("#", ...) do texts[i] = tostring((select(i, ...))) end
  say_(table.concat(texts, " "))
end
print = say

local function order(a, b)
  local ta, tb = type(a), type(b)
  if ta ~= tb then return ta < tb end
  if ta == "number" or ta == "string" then return a < b end
  return false
end
local next_ = next
function pairs(t)
  local keys = {}
  for k in next_, t do keys[#keys + 1] = k end
  table.sort(keys, order)
  local i = 0
  return function()
    i = i + 1
    if keys[i] ~= nil then return keys[i], t[keys[i]] end
  end, t, nil
end

-- Lua 5.2, for which templates were written, has these as well.
unpack, table.getn, table.maxn = table.unpack, function(t) return #t end, function(t) return #t end
math.pow, math.mod, math.log10 = function(a, b) return a ^ b end, math.fmod, function(a) return math.log(a, 10) end
math.cosh = function(a) return (math.exp(a) + math.exp(-a)) / 2 end
math.sinh = function(a) return (math.exp(a) - math.exp(-a)) / 2 end
math.tanh, math.atan2 = function(a) return math.sinh(a) / math.cosh(a) end, math.atan
math.ldexp = function(a, n) return a * 2.0 ^ n end

-- The numbers of Webots: x' = (1140671485 x + 12820163) mod 2^24.
local modulus, random = 2.0 ^ 24, 0.0
local function draw()
  random = (1140671485.0 * random + 12820163.0) % modulus
  return random
end
local wbrandom = {}
function wbrandom.seed(s) random = s + 0.0 end
function wbrandom.real(min, max)
  if min == nil then min, max = 0, 1 elseif max == nil then min, max = 0, min end
  return min + draw() * (max - min) / (modulus - 1)
end
function wbrandom.integer(min, max)
  if min == nil then min, max = 0, modulus - 1 elseif max == nil then min, max = 1, min end
  return min + math.tointeger(draw() % (1 + max - min))
end
math.randomseed = wbrandom.seed
function math.random(min, max)
  if min == nil then return draw() / modulus end
  return wbrandom.integer(min, max)
end

local function vector(keys)
  local v = {}
  local function each(f)
    return function(a, b)
      local out = {}
      for _, k in ipairs(keys) do out[k] = f(a[k], b and b[k]) end
      return out
    end
  end
  v.add = each(function(a, b) return a + b end)
  v.minus = each(function(a, b) return a - b end)
  function v.mult(a, s) return each(function(x) return x * s end)(a) end
  v.multiply = v.mult
  function v.dot(a, b)
    local sum = 0
    for _, k in ipairs(keys) do sum = sum + a[k] * b[k] end
    return sum
  end
  function v.norm(a) return math.sqrt(v.dot(a, a)) end
  function v.distance(a, b) return v.norm(v.minus(a, b)) end
  function v.normalize(a) return v.mult(a, 1 / v.norm(a)) end
  function v.equal(a, b)
    for _, k in ipairs(keys) do
      if a[k] ~= b[k] then return false end
    end
    return true
  end
  return v
end
local wbvector2 = vector{ "x", "y" }
function wbvector2.cross(a, b) return a.x * b.y - a.y * b.x end
function wbvector2.atan2(v) return math.atan(v.x, v.y) end
function wbvector2.angle(a, b) return wbvector2.atan2(wbvector2.minus(a, b)) end
function wbvector2.intersection(p1, p2, p3, p4)
  local r, s, between = wbvector2.minus(p2, p1), wbvector2.minus(p4, p3), wbvector2.minus(p3, p1)
  local parallel = wbvector2.cross(r, s)
  if parallel == 0 then return nil end
  local t, u = wbvector2.cross(between, s) / parallel, wbvector2.cross(between, r) / parallel
  if t >= 0 and t <= 1 and u >= 0 and u <= 1 then return wbvector2.add(p1, wbvector2.mult(r, t)) end
end
local wbvector3 = vector{ "x", "y", "z" }
function wbvector3.cross(a, b)
  return { x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, z = a.x * b.y - a.y * b.x }
end

-- Functions of rotations change their argument where those of Webots do.
local wbrotation = {}
function wbrotation.equal(a, b) return a.x == b.x and a.y == b.y and a.z == b.z and a.a == b.a end
function wbrotation.isvalid(r) return r.x ~= 0 or r.y ~= 0 or r.z ~= 0 end
function wbrotation.isidentity(r) return r.a == 0 end
function wbrotation.normalizeaxis(r)
  local n = wbvector3.norm(r)
  if n > 0 then r.x, r.y, r.z = r.x / n, r.y / n, r.z / n else r.x, r.y, r.z = 0, 1, 0 end
end
function wbrotation.normalizeangle(r) r.a = r.a - 2 * math.pi * math.floor(r.a / (2 * math.pi) + 0.5) end
function wbrotation.normalize(r)
  wbrotation.normalizeaxis(r)
  wbrotation.normalizeangle(r)
  return r
end
function wbrotation.fromquaternion(q)
  local n = wbvector3.norm(q)
  if n < 1e-10 then return { x = 0, y = 1, z = 0, a = 0 } end
  return { x = q.x / n, y = q.y / n, z = q.z / n, a = 2 * math.atan(n, q.w) }
end
function wbrotation.toquaternion(r)
  wbrotation.normalize(r)
  local s = math.sin(r.a / 2)
  return { w = math.cos(r.a / 2), x = r.x * s, y = r.y * s, z = r.z * s }
end
function wbrotation.tomatrix3(r)
  local c, s = math.cos(r.a), math.sin(r.a)
  local t = 1 - c
  return { r.x * r.x * t + c, r.x * r.y * t - r.z * s, r.x * r.z * t + r.y * s,
           r.x * r.y * t + r.z * s, r.y * r.y * t + c, r.y * r.z * t - r.x * s,
           r.x * r.z * t - r.y * s, r.y * r.z * t + r.x * s, r.z * r.z * t + c }
end
function wbrotation.frommatrix3(m)
  local cosine = math.max(-1, math.min(1, (m[1] + m[5] + m[9] - 1) / 2))
  local r = { x = m[8] - m[6], y = m[3] - m[7], z = m[4] - m[2], a = math.acos(cosine) }
  if not wbrotation.isvalid(r) then
    if cosine > 0 then return { x = 1, y = 0, z = 0, a = 0 } end
    -- Half a turn: the matrix is 2 n n' - 1.
    local function part(diagonal) return math.sqrt(math.max(0, (diagonal + 1) / 2)) end
    r.x, r.y, r.z = part(m[1]), part(m[5]), part(m[9])
    if r.x > 0 then
      if m[2] < 0 then r.y = -r.y end
      if m[3] < 0 then r.z = -r.z end
    elseif m[6] < 0 then
      r.z = -r.z
    end
  end
  return r
end
function wbrotation.combine(rA, rB)
  local a, b = wbrotation.toquaternion(rA), wbrotation.toquaternion(rB)
  return wbrotation.fromquaternion{
    w = a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    x = a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
    y = a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
    z = a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w }
end
function wbrotation.rotatevector3bymatrix3(m, v)
  return { x = m[1] * v.x + m[2] * v.y + m[3] * v.z,
           y = m[4] * v.x + m[5] * v.y + m[6] * v.z,
           z = m[7] * v.x + m[8] * v.y + m[9] * v.z }
end
function wbrotation.rotatevector3byrotation(r, v)
  return wbrotation.rotatevector3bymatrix3(wbrotation.tomatrix3(r), v)
end
function wbrotation.rotatevector3byquaternion(q, v)
  return wbrotation.rotatevector3byrotation(wbrotation.fromquaternion(q), v)
end

-- A uniform cubic B-spline through control points that are extended by two at each end.
local function spline(space, first)
  return function(given, subdivision)
    local function beyond(a, b) return space.add(a, space.minus(a, b)) end
    local head, tail = beyond(given[1], given[2]), beyond(given[#given], given[#given - 1])
    local points = { beyond(head, given[1]), head }
    for _, p in ipairs(given) do points[#points + 1] = p end
    points[#points + 1] = tail
    points[#points + 1] = beyond(tail, given[#given])
    local out = { given[1] }
    for i = 2 + first, #given + 1 do
      for j = 1, subdivision do
        local t = j / subdivision
        local weights = { (1 - t) ^ 3, 3 * t ^ 3 - 6 * t ^ 2 + 4, -3 * t ^ 3 + 3 * t ^ 2 + 3 * t + 1, t ^ 3 }
        local sum = space.mult(points[i - 1], weights[1] / 6)
        for k = 2, 4 do sum = space.add(sum, space.mult(points[i - 2 + k], weights[k] / 6)) end
        out[#out + 1] = sum
      end
    end
    return out
  end
end
local wbgeometry = { bspline2D = spline(wbvector2, 0), bspline3D = spline(wbvector3, 1) }
function wbgeometry.circle(radius, div, cx, cy, shift)
  local out = {}
  for i = 0, div do
    local a = 2 * math.pi * i / div + shift
    out[#out + 1] = { x = radius * math.cos(a) + cx, y = radius * math.sin(a) + cy }
  end
  return out
end
function wbgeometry.ispointinpolygon(x, y, polygon)
  local inside, a = false, polygon[#polygon]
  for _, b in ipairs(polygon) do
    if (a.y > y) ~= (b.y > y) and x < a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y) then inside = not inside end
    a = b
  end
  return inside
end
function wbgeometry.findclosest2Dpointinarray(reference, points)
  local best = points[1] or reference
  for _, p in ipairs(points) do
    if wbvector2.distance(reference, p) < wbvector2.distance(reference, best) then best = p end
  end
  return best
end
function wbgeometry.islistclockwise2D(points)
  local sum = 0
  for i, p in ipairs(points) do
    local q = points[i % #points + 1]
    sum = sum + (q.x - p.x) * (q.y + p.y)
  end
  return sum < 0
end

local wbcore = {}
function wbcore.deepcopy(v)
  if type(v) ~= "table" then return v end
  local out = {}
  for k, w in pairs(v) do out[wbcore.deepcopy(k)] = wbcore.deepcopy(w) end
  return setmetatable(out, getmetatable(v))
end
function wbcore.tablelength(t) return #t end
local wbmath = {}
function wbmath.round(x) return math.floor(x + 0.5) end
local wbstring = {}
function wbstring.split(text, pattern)
  local out, from = {}, 1
  while from <= #text do
    local first, last = text:find(pattern, from)
    if not first or last < first then break end
    if first > 1 then out[#out + 1] = text:sub(from, first - 1) end
    from = last + 1
  end
  if from <= #text then out[#out + 1] = text:sub(from) end
  return out
end
local wbfile = {}
function wbfile.fileexists() return false end
function wbfile.readtextfile(name) error("templates read and write no files: '" .. tostring(name) .. "'", 2) end
wbfile.writetextfile = wbfile.readtextfile

local stream = { write = function(_, ...) say(...) end }
io = { open = function(name) return nil, "templates read and write no files: '" .. tostring(name) .. "'" end,
       write = say, stdout = stream, stderr = stream }
local function zero() return 0 end
os = { time = zero, clock = zero, date = function() return "" end, getenv = function() end }
debug = { getinfo = function() return { source = context.proto, short_src = context.proto, currentline = 0 } end,
          traceback = function(text) return text end }

-- Pictures are for viewers: they are not made.
local gd = {}
setmetatable(gd, { __index = function() return function() return gd end end })

local modules = {
  wbrandom = wbrandom, wbvector2 = wbvector2, wbvector3 = wbvector3, wbrotation = wbrotation, wbgeometry = wbgeometry,
  wbcore = wbcore, wbmath = wbmath, wbstring = wbstring, wbfile = wbfile, math = math, string = string, table = table,
  io = io, os = os, debug = debug, gd = gd,
  wblimits = { maxdouble = 2.0 ^ 53, mindouble = -2.0 ^ 53 },
}
function require(name)
  return modules[name] or error("there is no module '" .. tostring(name) .. "'", 2)
end
package = { path = "", cpath = "", loaded = modules }
