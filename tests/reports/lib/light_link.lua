-- Links that are light for what acts on their joints.
include "house.lua"

--- Builds the servers, with steps of `step` seconds and gravity along -z.
function lightWorld(step)
  files() scene() physics(engineOption())
  local sim = simulation()
  sim.step = step
  get("/usr/scene/world").timestep = step
  return sim
end

--- A link along x from the transform `place`, below it: the transform `name` with the body, its centre `reach` m away,
--- with the moments of inertia `inertia`. Returns the transform of the link's other end, and the body.
function lightLink(place, name, mass, reach, inertia)
  local at = place:new("Transform", name)
  at.localPos = { reach, 0, 0 }
  local body = at:new("RigidBody", "body")
  body:setMassParameters(mass, 0, 0, 0, inertia, inertia, inertia, 0, 0, 0)
  local tip = at:new("Transform", "tip")
  tip.localPos = { reach, 0, 0 }
  return tip, body
end

--- A hinge about y in the origin of `place`, of the body of the link `name` below it, and of `second`, a path from the
--- joint; none: the world.
function lightHinge(place, name, second)
  local joint = place:new("HingeJoint", "hinge")
  joint:attach("../" .. name .. "/body", second or "")
  joint:setAnchor(0, 0, 0)
  joint:setAxis(1)
  return joint
end

--- Calls `check` once at a time [s].
function once(sim, time, check)
  on("sense", function(_, event)
    if event.cycle == math.floor(time / sim.step + 0.5) then check() end
  end)
end
