-- A world or robot of Webots, as the importer makes it.
include "house.lua"

--- Starts a simulation in which models are imported into /usr/scene.
function webotsCase()
  files() scene() physics(engineOption()) simulation()
end

--- Imports a file. Returns whether it could, and the error.
function imports(file, strict)
  get("/sys/server/scene/webots").strict = strict or false
  return pcall(function() get("/usr/scene"):importScene(file) end)
end

--- All nodes of a class below a node.
function all(node, class, found)
  found = found or {}
  for _, child in ipairs(node:children()) do
    if child.class == class then found[#found + 1] = child end
    all(child, class, found)
  end
  return found
end
