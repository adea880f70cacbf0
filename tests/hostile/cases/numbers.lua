-- row: A4
-- input: every property and method of bodies, colliders, joints, motors, controllers, handlers, the world and the
--   engine gets numbers that no engine can compute with
-- right: each is refused or survived: all bodies stay where numbers are, and the host lives
-- engines: all
-- args: --duration 1e6 --log-level error
-- slow: yes
-- expect: right: trials
include "house.lua"
local talk = option{ name = "talk", default = false, doc = "Says each trial, for one that ends the host." }
local only = option{ name = "only", default = "", doc = "Only trials that contain this text." }
files() scene() physics(engineOption()) simulation()

-- The quick case has three of them.
local VALUES = QUICK and { 1e308, -1e20, 1e-320 } or { 1e308, -1e308, 1e20, -1e20, 1e9, 1e-320, 0, -1, 1 / 0, 0 / 0 }
local CYCLES = 2
local space = get "/usr/scene/space"
space:new("PlaneCollider", "ground"):new("ContactJointHandler", "surface")

-- ---- what is tried ----

--- A body with a collider that touches the ground.
local function bodyAt(parent, name, place, collider)
  local node = parent:new("Transform", name)
  node.localPos = place
  node:new("RigidBody", "body"):setBoxTotal(1, 0.4, 0.4, 0.4)
  local shape = node:new(collider or "BoxCollider", "shape")
  if not collider then shape.boxLengths = { 0.4, 0.4, 0.4 } end
  shape:new("ContactJointHandler", "surface")
  return node, shape
end

local TETRAHEDRON = { 0, 0, -0.2, 0.3, 0, 0.2, -0.2, 0.2, 0.2, -0.2, -0.2, 0.2 }
local SHAPES = {
  BoxCollider = function(s) s.boxLengths = { 0.4, 0.4, 0.4 } end,
  SphereCollider = function(s) s.radius = 0.2 end,
  CapsuleCollider = function(s) s:setParams(0.2, 0.4) end,
  CylinderCollider = function(s) s:setParams(0.2, 0.4) end,
  ConvexCollider = function(s) s.vertices = TETRAHEDRON end,
  TriMeshCollider = function(s) s.vertices = TETRAHEDRON s.triangles = { 0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2 } end,
  RayCollider = function(s) s:setParams({ 0, 0, 0 }, { 0, 0, -1 }, 1) end,
  PlaneCollider = function(s) s:setParams{ 0, 0, 1, -1 } end,
}
-- Classes of the engine's plugin without a form of their own.
local WITHOUT = { "ConcaveCollider", "ConeCollider", "CompoundCollider", "EmptyCollider",
                  "Generic6DOFJoint", "ConeTwistJoint" }
local JOINTS = { "HingeJoint", "UniversalJoint", "Hinge2Joint", "BallJoint", "SliderJoint", "FixedJoint",
                 "AngularMotor" }
local CONTROLLERS = { "DragController", "VelocityController", "FPSController", "Battery" }

--- name, and a function that makes it below a node; returns the nodes that are tried.
local specimens = {}
local function specimen(name, make) specimens[#specimens + 1] = { name = name, make = make } end
specimen("RigidBody", function(at)
  local node, shape = bodyAt(at, "one", { 0, 0, 0.2 })
  return { node, node:find("body"), shape:find("surface") }
end)
for class, form in pairs(SHAPES) do
  specimen(class, function(at)
    local _, shape = bodyAt(at, "one", { 0, 0, 0.2 }, class)
    form(shape)
    return { shape }
  end)
end
specimen("TransformCollider", function(at)
  local node, outer = bodyAt(at, "one", { 0, 0, 0.2 }, "TransformCollider")
  local inner = outer:new("SphereCollider", "inner")
  inner.radius = 0.2
  return { outer, inner }
end)
specimen("HeightFieldCollider", function(at)
  local field = at:new("HeightFieldCollider", "field")
  field.columns = 2
  field.heights = { 0, 0.1, 0.2, 0.1 }
  field.size = { 2, 2, 1 }
  bodyAt(at, "one", { 0, 0, 0.4 })
  return { field }
end)
for _, class in ipairs(JOINTS) do
  specimen(class, function(at)
    bodyAt(at, "one", { 0, 0, 0.3 })
    bodyAt(at, "two", { 0, 0, 0.8 })
    local joint = at:new(class, "joint")
    joint:attach("../one/body", "../two/body")
    if joint:isA("HingeJoint") then joint:setAxis(1) end
    if joint:isA("FixedJoint") then joint:setFixed() end
    joint:enableFeedback(true)
    if class == "AngularMotor" then joint.numAxes = 1 joint:setMotorAxis(0, 0, { 1, 0, 0 }) end
    return { joint }
  end)
end
for _, class in ipairs(CONTROLLERS) do
  specimen(class, function(at)
    local node = bodyAt(at, "one", { 0, 0, 0.3 })
    return { node:new(class, "controller") }
  end)
end
-- What only one engine reads, of the world, of colliders and of joints.
for _, class in ipairs(get("/classes"):children()) do
  if not class.abstract and class:isA("IExtension") then
    specimen(class.name, function(at)
      bodyAt(at, "one", { 0, 0, 0.3 })
      bodyAt(at, "two", { 0, 0, 0.8 })
      local hinge = at:new("HingeJoint", "hinge")
      hinge:attach("../one/body", "../two/body")
      hinge:setAxis(1)
      local out = {}
      for _, above in ipairs{ get "/usr/scene/world", hinge, at:find("one/shape") } do
        local good, node = pcall(above.new, above, class.name, "extension")
        if good then out[#out + 1] = node end
      end
      return out
    end)
  end
end
for _, path in ipairs{ "/usr/scene/world", "/sys/server/physics", "/sys/server/physics/engine",
                       "/sys/server/physics/collision" } do
  specimen(path, function(at)
    bodyAt(at, "one", { 0, 0, 0.2 })
    return { get(path) }
  end)
end

-- ---- trials ----

local SKIPPED = { unlinkLeaf = true, settle = true, contactsPerPair = false }

local function lists(v) return { { v, v, v }, { v, 1, 1 }, { 1, v, 1 }, { 0, 0, v } } end

--- The values that stand for `v` in a type.
local function inType(type, v)
  if type == "vec3" then return lists(v) end
  if type == "number" then return { v } end
  if type == "integer" then
    return { math.tointeger(v) or (v > 0 and math.maxinteger or v < 0 and math.mininteger or 0) }
  end
  if type == "list of number" or type == "numbers" then
    return { { v, v, v, v, v, v }, { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, v, v, v, 1 },
             { v, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 },
             { v, v }, { v, v, v, v }, { 0, 0, 1, v }, { v, 1, 0, 0, 0, 1, 0, 0, 1 }, { v } }
  end
end

--- The arguments that are tried for a method: all extreme, and each.
local function argumentsOf(method, v)
  local plain, extreme = {}, {}
  for i, parameter in ipairs(method.parameters) do
    local type = parameter:match(": (.*)$") or parameter
    local values = inType(type, v)
    if values then
      plain[i], extreme[i] = inType(type, 1)[1], values
      if type == "vec3" then plain[i] = { 0, 0, 1 } end
      if type == "integer" then plain[i] = 0 end
    elseif type == "bool" or type == "boolean" then
      plain[i] = true
    else
      return {}
    end
  end
  local out = {}
  local function add(which)
    for variant = 1, 8 do
      local arguments, any = {}, false
      for i = 1, #method.parameters do
        arguments[i] = plain[i]
        if extreme[i] and (which == 0 or which == i) and extreme[i][math.min(variant, #extreme[i])] then
          arguments[i] = extreme[i][math.min(variant, #extreme[i])]
          any = any or variant <= #extreme[i]
        end
      end
      if any then out[#out + 1] = arguments end
    end
  end
  if #method.parameters > 1 then add(0) end
  for i = 1, #method.parameters do if extreme[i] then add(i) end end
  return out
end

local function shown(v)
  if type(v) ~= "table" then return tostring(v) end
  local all = {}
  for i, e in ipairs(v) do all[i] = shown(e) end
  return "{" .. table.concat(all, ", ") .. "}"
end

--- All trials: specimen, number of its node, what is done.
local trials = {}
do
  local at = space:new("Transform", "specimen")
  for _, s in ipairs(specimens) do
    local place = at:new("Transform", "at")
    for number, node in ipairs(s.make(place)) do
      local class = get("/classes/" .. node.class)
      local function try(what, ...)
        local label = s.name .. ": " .. node.class .. "." .. what
        if label:find(only, 1, true) then
          trials[#trials + 1] = { specimen = s, node = number, label = label, arguments = { ... } }
        end
      end
      for _, v in ipairs(VALUES) do
        for _, p in ipairs(class:properties()) do
          if not p.readOnly and not SKIPPED[p.name] then
            for _, value in ipairs(inType(p.type, v) or {}) do
              try(p.name .. " = " .. shown(value), p.name, value)
            end
          end
        end
        for _, m in ipairs(class:methods()) do
          if not SKIPPED[m.name] and not m.name:find("^get") then
            for _, arguments in ipairs(argumentsOf(m, v)) do
              try(m.name .. shown(arguments), m.name, arguments, true)
            end
          end
        end
      end
    end
    place:delete()
    local extension = get "/usr/scene/world/extension"
    if extension then extension:delete() end
  end
  at:delete()
end

--- What no trial has would be forgotten.
for _, name in ipairs(get("/plugins/physics").classes) do
  local class, tried = get("/classes/" .. name), false
  local sound = class.abstract or not (class:isA("Collider") or class:isA("Joint") or class:isA("BodyController") or
                                       class:isA("Body"))
  for _, s in ipairs(specimens) do tried = tried or s.name == name end
  for _, without in ipairs(WITHOUT) do tried = tried or without == name end
  if not (sound or tried or only ~= "" ) then log.error("wrong: " .. name .. " is not tried") end
end

-- ---- the walk ----

local function finite(v)
  if type(v) == "number" then return v == v and math.abs(v) < 1e30 end
  for _, e in ipairs(v) do if not finite(e) then return false end end
  return true
end

--- What is no number below a node.
local function strange(node, out)
  for _, child in ipairs(node:children()) do
    if child:isA("RigidBody") then
      for _, name in ipairs{ "position", "velocity", "angularVelocity", "mass" } do
        if not finite(child[name]) then out[#out + 1] = name .. " " .. shown(child[name]) end
      end
    end
    strange(child, out)
  end
  return out
end

local at, restore, current, number, refused, wrong, age = nil, nil, nil, 0, 0, 0, 0

local function begin()
  number = number + 1
  current = trials[number]
  at = space:new("Transform", "specimen")
  local node = current.specimen.make(at)[current.node]
  local name, value, call = table.unpack(current.arguments)
  if talk then log.error(current.label) end
  restore = nil
  if not call and node.path:sub(1, #at.path) ~= at.path then
    local old = node[name]
    restore = function() node[name] = old end
  end
  local good
  if call then
    good = pcall(function() node[name](node, table.unpack(value)) end)
  else
    good = pcall(function() node[name] = value end)
  end
  age = 0
  return good
end

local function finish()
  local found = strange(at, {})
  if #found > 0 and wrong < 20 then
    wrong = wrong + 1
    log.error("wrong: " .. current.label .. ": " .. table.concat(found, "; "))
  end
  if restore then restore() end
  local extension = get "/usr/scene/world/extension"
  if extension then extension:delete() end
  at:delete()
  at = nil
end

on("rule", function()
  if at then
    age = age + 1
    if age < CYCLES then return end
    finish()
  end
  -- Those that are refused take no cycle.
  while number < #trials do
    if begin() then return end
    refused = refused + 1
    finish()
  end
  do
    log.error(string.format("%s: trials: %d, %d of them were refused",
                            #trials > 1 and wrong == 0 and "right" or "wrong", #trials, refused))
    get("/sys/server/simulation"):stop()
  end
end)
