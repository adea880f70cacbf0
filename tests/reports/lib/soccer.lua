-- Players inside the host for cases of soccer, and their bodies.

--- A player whose script is `think(cycle)`, which returns its actions; it joins by itself.
function player(t)
  local mind, thoughts = new("ScriptBehavior", "/usr/agent/" .. t.name), 0
  mind:on("start", function(self) self.actions = "(scene rsg/agent/sphere.rsg)" end)
  mind:on("think", function(self, event)
    thoughts = thoughts + 1
    if thoughts <= 3 then
      self.actions = ("(init (unum %d)(teamname %s))"):format(t.unum, t.team)
    else
      self.actions = t.think and t.think(event.data) or ""
    end
  end)
  return mind
end

--- The first rigid body at `path` or below it; nil if there is none yet.
function body(path)
  local function below(node)
    if node:isA "RigidBody" then return node end
    for _, child in ipairs(node:children()) do
      local found = below(child)
      if found then return found end
    end
  end
  local node = get(path)
  return node and below(node)
end

--- The body of the sphere of the agent with this number; nil if there is none yet.
function robot(number) return body("/usr/scene/AgentAspect" .. number) end

--- Puts a body down at rest.
function place(b, x, y, z)
  b:setPosition(x, y, z or 0.22)
  b.velocity = { 0, 0, 0 }
end
