-- A model in MJCF, URDF or Webots' language on the ground: by default a standing Booster T1.
--
--     sparkhost --config mjcf.lua
--     sparkhost --config mjcf.lua --set model=rsg/robots/k1.xml
--     sparkhost --config mjcf.lua --set model=rsg/robots/rover.wbt --set stiffness=0
--     sparkhost --config mjcf.lua --scene-path ~/models --set model=humanoid.xml --set stiffness=0
include "house.lua"
include "materials.lua"

local model     = option{ name = "model", default = "rsg/robots/t1.xml", doc = "The model file." }
local height    = option{ name = "height", default = 0.0, doc = "How far above its own place it begins, in metres." }
local engine    = option{ name = "engine", default = "MujocoEngine", doc = "Class of the engine." }
local timestep  = option{ name = "timestep", default = 0.005, doc = "Length of the engine's steps, in seconds." }
local stiffness = option{ name = "stiffness", default = 200.0,
  doc = "Of the controllers that hold every hinge where it is, at most, in Nm/rad; 0: none." }

files()
scene()
materials()
physics(engine)
simulation()
web()
control()

local world = get "/usr/scene/world"
world.timestep = timestep
if get "/classes/MujocoOptions" then
  local medium = world:new("MujocoOptions", "mujoco")
  medium.density, medium.viscosity = 1.2, 2e-5            -- air
end
get("/usr/scene/space"):new("PlaneCollider", "ground"):new("ContactJointHandler", "surface").contactBounceMode = false

local place = get("/usr/scene"):new("Transform", "place")
place:setLocalPos(0, 0, height)
place:importScene(model)

-- A controller acts once in each step of the engine. If it is too stiff for the inertia that it moves (at least that of
-- its rotor), the joint oscillates with growing amplitude.
local function hold(node)
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
    hold(child)
  end
end
if stiffness > 0 then hold(place) end
