-- A world for models of other simulators, and for agents that drive them. What mjcf.lua, urdf.lua and webots.lua share.
include "house.lua"
include "materials.lua"

-- A controller acts once in each step of the engine. If it is too stiff for the inertia that it moves (at least that of
-- its rotor), the joint oscillates with growing amplitude.
local function hold(node, stiffness, timestep)
  for _, child in ipairs(node:children()) do
    if child.class == "HingeJoint" then
      local rotor = child:getArmature(0)
      local most, damping = stiffness, stiffness / 40
      if rotor > 0 then
        most = math.min(most, 0.5 * rotor / timestep ^ 2)
        damping = math.min(damping, 0.8 * rotor / timestep)
      end
      child:setController(0, most, damping, 0, 0, 0, 1000)
    end
    hold(child, stiffness, timestep)
  end
end

-- The rule that gives each agent its robot: that of the option `model`, or the one that it asks for. The first one has
-- the place of the model that stands there, the others stand beside it. `import`: imports a model below a node.
local function robotsForAgents(control, model, apart, place, import)
  state.agents = {}                             -- path of the aspect of each place
  local rule = control:new("ScriptAspect", "robots")
  rule:on("agentConnected", function(self, event)
    local aspect, number = get(event.data), 1
    while state.agents[number] do number = number + 1 end
    state.agents[number] = event.data
    local matrix = place.localTransform
    aspect.localPos = { matrix[13], matrix[14] + (number - 1) * apart, matrix[15] }
    if model == "" then return end              -- it sends (scene FILE)
    for _, child in ipairs(place:children()) do child:delete() end
    aspect:find("_CreateEffector"):delete()
    aspect:new("ScriptEffector", "scene"):on("perform", function(self, action)
      if action.data[2] ~= model then return "expected (scene " .. model .. "), the robot of this simulation" end
    end)
    import(aspect)
  end)
  rule:on("agentLeaving", function(self, event)
    for number, path in pairs(state.agents) do
      if path == event.data then state.agents[number] = nil end
    end
  end)
end

--- The world. `t`: what the options model, engine, timestep and stiffness are by default, and `what` the model is.
function robotWorld(t)
  local model     = option{ name = "model", default = t.model, doc = t.what .. "; empty: agents choose." }
  local height    = option{ name = "height", default = 0.0, doc = "How far above its own place it begins, in metres." }
  local engine    = option{ name = "engine", default = t.engine, doc = "Class of the engine." }
  local timestep  = option{ name = "timestep", default = 0.005, doc = "Length of the engine's steps, in seconds." }
  local stiffness = option{ name = "stiffness", default = t.stiffness,
    doc = "Of the controllers that hold every hinge where it is, until an agent drives it, at most, in Nm/rad; " ..
          "0: none." }
  local most      = option{ name = "agents", default = 1, doc = "How many agents may drive a robot each; 0: no port." }
  local apart     = option{ name = "apart", default = 2.0, doc = "From one robot to the next, in metres." }

  files()
  scene()
  materials()
  physics(engine)
  simulation()
  local control_ = most > 0 and agents{}
  plugin "sensors"
  plugin "effectors"
  web()
  control()

  local world = get "/usr/scene/world"
  world.timestep = timestep
  if get "/classes/MujocoOptions" then
    local medium = world:new("MujocoOptions", "mujoco")
    medium.density, medium.viscosity = 1.2, 2e-5          -- air
  end
  get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false

  local place = get("/usr/scene"):new("Transform", "place")
  place:setLocalPos(0, 0, height)
  local function import(node)
    node:importScene(model)
    if stiffness > 0 then hold(node, stiffness, timestep) end
  end
  if model ~= "" then import(place) end
  if control_ then
    control_.maxAgents, control_.robotFolder = most, ""
    robotsForAgents(control_, model, apart, place, import)
  end
end
