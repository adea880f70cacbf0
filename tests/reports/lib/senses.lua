-- A world with an agent whose percepts a case looks at.
include "house.lua"

--- Calls look(percepts, time) with what the agent below `place` has sensed; percepts are by class and name: "ACC hip".
function watch(aspect, look)
  aspect:new("ScriptBehavior", "watcher"):on("think", function(_, event)
    local seen = {}
    for _, p in ipairs(event.data) do
      local name = type(p[2]) == "table" and p[2][2] or p[2] or ""
      seen[p[1] .. " " .. name] = p
    end
    look(seen, event.time)
  end)
end

--- True in the cycle of that time.
function isAt(time, wanted) return math.abs(time - wanted) < 0.001 end

--- A bar that floats without gravity, with an accelerometer 0.8 m from its centre. Returns its body and its agent.
function freeBar()
  files() scene() physics(engineOption()) simulation() agents{ port = 0 }
  plugin "sensors"
  get("/usr/scene/world").gravity = { 0, 0, 0 }
  local bar = new("Transform", "/usr/scene/bar")
  local body = bar:new("RigidBody", "body")
  body:setMassParameters(2, 0, 0, 0, 0.5, 0.5, 0.5, 0, 0, 0)
  local agent = bar:new("AgentAspect", "agent")
  local tip = agent:new("Transform", "tip")
  tip.localPos = { 0.8, 0, 0 }
  tip:new("Accelerometer", "tip")
  return body, agent
end
